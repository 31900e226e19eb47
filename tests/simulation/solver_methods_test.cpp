// The solvers beside PBF: what each promises at rest, against closed forms and energies by brute force, and
// what every step has to keep: flight, momentum, determinism, state.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "core/simulation/state.h"
#include "core/simulation/statistics.h"
#include "core/solver/press.h"
#include "core/solver/solvers.h"
#include "core/solver/step.h"
#include "core/study/study.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace solver_methods_test {

using namespace migiwa::testing;

Scene solvedBy(Scene scene, SolverMethod method) {
  scene.solver.takeMethod(method);
  return scene;
}

class SolverMethods : public ::testing::TestWithParam<SolverMethod> {
 protected:
  Scene with(Scene scene) const { return solvedBy(std::move(scene), GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Each, SolverMethods,
                         ::testing::Values(SolverMethod::wcsph, SolverMethod::pcisph, SolverMethod::dfsph),
                         [](const auto& tested) {
                           return std::string(kSolverMethodNames[static_cast<std::size_t>(tested.param)]);
                         });

Vec3d momentum(const Simulation& simulation) {
  Vec3d sum = Vec3d::Zero();
  for (const Float4& v : simulation.view().velocities) sum += v.xyz().cast<double>();
  return sum;
}

// A block with no wall near moves as a stone: symplectic Euler falls g dt^2 k (k + 1) / 2 in k steps.
TEST_P(SolverMethods, ABlockFallsFreely) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.3, 0.3, 0.3}, {0.5, 1, 0});
  scene.solver.substeps = 1;
  scene = with(scene);
  Simulation simulation(scene, 1);
  const Vec3d before = momentum(simulation);
  constexpr int kFrames = 40;
  for (int k = 0; k < kFrames; ++k) simulation.advanceFrame();
  const auto count = static_cast<double>(simulation.view().velocities.size());
  const Vec3d gained = (momentum(simulation) - before) / count;
  EXPECT_LT((gained - kFrames * scene.solver.timeStep * scene.gravity).norm(), 2e-4);
  for (const Float4& v : simulation.view().velocities)
    EXPECT_LT((v.xyz().cast<double>() - momentum(simulation) / count).norm(), 2e-3);
}

TEST_P(SolverMethods, BlocksThatMeetKeepTheirMomentum) {
  Scene scene = emptyScene();
  addFluid(scene, Vec3d::Zero(), {0.3, 0.3, 0.3}, {1, 0.1, 0});
  addFluid(scene, {0.32, 0.1, 0}, {0.5, 0.3, 0.3}, {-1.5, 0, 0.2});
  Simulation simulation(with(scene), 1);
  const Vec3d before = momentum(simulation);
  double fastest = 0;
  for (int k = 0; k < 40; ++k) {
    simulation.advanceFrame();
    fastest = std::max(fastest, simulation.statistics().maxSpeed);
  }
  const auto count = static_cast<double>(simulation.view().velocities.size());
  EXPECT_LT((momentum(simulation) - before).norm(), 2e-5 * count);
  EXPECT_LT(fastest, 4);
  EXPECT_NE((simulation.view().velocities.front().xyz() - Vec3f(1, 0.1F, 0)).norm(), 0);
}

// A block is thrown at a plate that moves at 1 m/s through free space: the only force is the plate's, so that
// its work is the impulse that the block gets, however few iterations find it.
TEST_P(SolverMethods, AMovingWallDoesTheWorkOfItsImpulse) {
  Scene scene = with(parseScene(R"({ "format": 1, "particle_spacing": 0.05, "gravity": [0, 0, 0],
      "fluid": [{ "shape": "box", "min": [0, 0, 0], "max": [0.3, 0.3, 0.3], "velocity": [-4, 0, 0] }],
      "boundary": { "surfaces": [{ "shape": "box", "fluid": "outside", "min": [-0.4, -1, -1],
          "max": [-0.1, 1.3, 1.3], "motion": { "velocity": [1, 0, 0] } }] } })",
                                "plate.json"));
  for (const int least : {1, scene.solver.minIterations}) {
    scene.solver.minIterations = least;
    Simulation simulation(scene, 1);
    const double before = momentum(simulation).x();
    for (int k = 0; k < 20; ++k) simulation.advanceFrame();
    const double impulse = momentum(simulation).x() - before;
    ASSERT_GT(impulse, 4.5 * static_cast<double>(simulation.view().positions.size()));
    EXPECT_NEAR(simulation.statistics().energy.walls / impulse, 1, 1e-5) << least;
  }
}

// p = rho g z, and each within its own bound.
TEST_P(SolverMethods, WaterAtRestHasThePressureOfItsDepth) {
  constexpr int kLayers = 12;
  Simulation simulation(with(stillTank({8, kLayers, 8})), 1);
  simulation.watchPressure(true);
  // What compressed water gives back, e'(s) = p / (rho0 s^2) with Tait's p and c^2 = 2 g H / 0.01.
  double stored = 0;
  if (GetParam() == SolverMethod::wcsph) {
    const double stiffness = 2 * 9.81 * kLayers * kSpacing / 0.01 / 7;
    for (const float density : simulation.view().density) {
      const double s = std::max(static_cast<double>(density), 1.0);
      stored += stiffness * (std::pow(s, 6) / 6 + 1 / s - 7.0 / 6);
    }
    stored /= static_cast<double>(simulation.view().density.size());
  }
  PressureProfile profile;
  double largest = 0, mean = 0;
  int frames = 0;
  for (int frame = 0; frame < 400; ++frame) {
    simulation.advanceFrame();
    if (frame < 250) continue;
    profile.sample(simulation);
    for (const float density : simulation.view().density) {
      const auto error = static_cast<double>(std::max(density - 1, 0.0F));
      largest = std::max(largest, error);
      mean += error / static_cast<double>(simulation.view().density.size());
    }
    ++frames;
  }
  double products = 0, squares = 0;
  for (const PressureLayer& layer : profile.layers()) {
    products += layer.particles * layer.pressure * layer.depth;
    squares += layer.particles * layer.depth * layer.depth;
  }
  EXPECT_NEAR(products / squares / (1000 * 9.81), 1, 0.06);
  EXPECT_LE(mean / frames, 0.01);
  if (GetParam() == SolverMethod::wcsph) {
    EXPECT_LE(largest, 0.01);
  }
  const RunStatistics& run = simulation.statistics();
  EXPECT_FALSE(run.failed());
  // Energy has no source but the density errors of a lattice at walls.
  EXPECT_LT(run.energy.mostGained, stored + 0.04);
  double squaredSpeed = 0;
  for (const Float4& v : simulation.view().velocities)
    squaredSpeed += static_cast<double>(v.xyz().squaredNorm());
  EXPECT_LT(std::sqrt(squaredSpeed / static_cast<double>(simulation.view().velocities.size())), 0.06);
}

TEST_P(SolverMethods, TheStateIsTheSameForAnyNumberOfThreadsAndVectors) {
  const Scene scene = with(smallDamBreak());
  const auto hashAfter = [&](int threads) {
    Simulation simulation(scene, threads);
    for (int k = 0; k < 40; ++k) simulation.advanceFrame();
    return simulation.stateHash();
  };
  const std::uint64_t alone = hashAfter(1);
  for (const int threads : {2, 3, 5}) EXPECT_EQ(hashAfter(threads), alone);
  onTargets(promisesEqualState, [&] { EXPECT_EQ(hashAfter(1), alone); });
}

TEST_P(SolverMethods, ASavedStateGoesOnAsIfNothingHadHappened) {
  const Scene scene = with(smallDamBreak());
  Simulation straight(scene, 1);
  for (int k = 0; k < 20; ++k) straight.advanceFrame();
  const StateImage image = StateImage::of(straight);
  Simulation resumed(scene, 2);
  image.restore(resumed);
  for (int k = 0; k < 20; ++k) straight.advanceFrame(), resumed.advanceFrame();
  EXPECT_EQ(straight.stateHash(), resumed.stateHash());
}

// Into edges and corners at twice the speed of the fall, too.
TEST_P(SolverMethods, NoParticleIsLostInACornerOrADamBreak) {
  Scene thrown = smallDamBreak();
  thrown.surfaces.clear(), thrown.fluid.clear();
  addTank(thrown, Vec3d::Zero(), {0.6, 0.6, 0.6});
  addFluid(thrown, {0.3, 0.3, 0.3}, {0.55, 0.55, 0.55}, {-4, -4, -4});
  for (const Scene& scene : {with(smallDamBreak()), with(thrown)}) {
    Simulation simulation(scene, 2);
    const std::size_t count = simulation.view().positions.size();
    for (int k = 0; k < 160; ++k) simulation.advanceFrame();
    EXPECT_FALSE(simulation.statistics().failed());
    EXPECT_EQ(simulation.view().positions.size(), count);
    EXPECT_LT(simulation.statistics().maxPenetration, 1e-4);
  }
}

// Solenthaler & Pajarola found steps 35 times those of WCSPH in their scene.
TEST(SolverSteps, OfPcisphAreTenTimesAsLongAsThoseOfWcsph) {
  Scene scene = smallDamBreak();
  scene.solver.timeStep = 0.04;
  const auto steps = [&](SolverMethod method) {
    Simulation simulation(solvedBy(scene, method), 2);
    for (int k = 0; k < 10; ++k) simulation.advanceFrame();
    EXPECT_FALSE(simulation.statistics().failed());
    return simulation.statistics().steps;
  };
  EXPECT_GE(steps(SolverMethod::wcsph), 10 * steps(SolverMethod::pcisph));
}

// Sound at a compression of 1 % is ten times as fast as the fall, and goes 0.4 support radii in a step. A
// fall askew is along all axes, and a plane is no part of the scene's bounds.
TEST(SolverSteps, OfWcsphAreThoseOfTheWholeFall) {
  constexpr double kFrame = 0.04, kGravity = 9.81;
  const auto steps = [&](Scene scene) {
    scene.solver.takeMethod(SolverMethod::wcsph);
    scene.solver.timeStep = kFrame;
    Simulation simulation(scene, 1);
    simulation.advanceFrame();
    return static_cast<double>(simulation.statistics().steps);
  };
  const auto least = [&](double way) {
    return kFrame * 10 * std::sqrt(2 * kGravity * way) / (0.4 * 2.25 * kSpacing);
  };
  Scene askew = emptyScene();
  addFluid(askew, Vec3d::Zero(), {0.3, 0.3, 0.3});
  addTank(askew, Vec3d::Zero(), {0.3, 0.3, 0.3});
  askew.gravity = -kGravity / std::sqrt(3) * Vec3d::Ones();
  EXPECT_GE(steps(askew), least(0.3 * std::sqrt(3)));
  Scene onPlane = emptyScene();
  addFluid(onPlane, {0, 1, 0}, {0.3, 1.3, 0.3});
  onPlane.surfaces.push_back(std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY()));
  onPlane.gravity = {0, -kGravity, 0};
  EXPECT_GE(steps(onPlane), least(1.3));
}

/// Jittered water that is squeezed into the corner of a box, and what solvers find of it.
class SqueezedWater {
 public:
  explicit SqueezedWater(SolverMethod method)
      : pool_(1),
        boundary_(
            {std::make_shared<Box>(Vec3d::Zero(), Vec3d(0.3, 0.6, 0.3), Box::Fluid::inside, Rotation{})}),
        state_(pool_, boundary_) {
    state_.parameters.takeMethod(method);
    state_.spacing = static_cast<float>(kSpacing);
    state_.supportRadius = static_cast<float>(state_.parameters.supportRatio * kSpacing);
    state_.lattice = restingLattice(state_.parameters.kernel, state_.parameters.supportRatio);
    state_.timeStep = 0.002F;
    gamma_ = makeGammaMethod(0, {boundary_, state_.parameters.kernel, state_.supportRadius});
    state_.gammaMethod = gamma_.method.get();
    std::uint32_t bits = 3;
    const auto random = [&bits] {
      bits = bits * 1664525U + 1013904223U;
      return static_cast<double>(bits >> 8) / 16777216.0 - 0.5;
    };
    for (int k = 0; k < 6 * 6 * 6; ++k) {
      const Vec3d cell(k % 6, k / 6 % 6, k / 36);
      const double x = random(), y = random(), z = random();
      places_.push_back(0.96 * kSpacing * (cell + Vec3d(0.6, 0.6, 0.6) + 0.1 * Vec3d(x, y, z)));
      velocities_.push_back(0.3 * Vec3d(y, z, x));
    }
    look();
  }

  StepState& state() { return state_; }
  std::vector<Vec3d>& places() { return places_; }

  /// Density and factors of the places, gamma evaluated there and nowhere else.
  void look() {
    Particles& particles = state_.particles;
    const std::size_t n = places_.size();
    particles.position.clear(), particles.velocity.clear(), particles.id.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      particles.position.emplace_back(Vec3f(places_[i].cast<float>()));
      particles.velocity.emplace_back(Vec3f(velocities_[i].cast<float>()));
      particles.id[i] = static_cast<std::uint32_t>(i);
    }
    state_.before.velocity = particles.velocity;
    state_.current = particles.position;
    state_.current.emplace_back();
    state_.wallSlots.clear(), state_.wallSlot.clear();
    state_.projectedPressure.assign(n, 0);
    stages::searchNeighbours(state_);
    stages::evaluateGamma(state_);
    state_.errors.clear();
    state_.iterations = 0;
    press::measure(state_);
  }
  std::size_t indexOf(std::uint32_t id) const {
    const auto& ids = state_.particles.id;
    return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
  }

 private:
  ThreadPool pool_;
  Boundary boundary_;
  StepState state_;
  PickedGamma gamma_;
  std::vector<Vec3d> places_, velocities_;
};

// The push is the slope of the energy sum e(s), e'(s) = p / (rho0 s^2), taken here by differences of it:
// inside, and at a wall, an edge and a corner, where gamma's part is the wall's reaction.
TEST(SolverPush, IsTheSlopeOfTheEnergyOfTheCorrectedDensity) {
  constexpr double kStiffness = 10;  // c^2 / 7 (m^2/s^2)
  SqueezedWater water(SolverMethod::wcsph);
  const auto energy = [&] {
    double sum = 0;
    for (const float density : water.state().density) {
      const double s = std::max(static_cast<double>(density), 1.0);
      sum += kStiffness * (std::pow(s, 6) / 6 + 1 / s - 7.0 / 6);
    }
    return sum;
  };
  StepState& state = water.state();
  const std::size_t n = state.particles.size();
  for (std::size_t i = 0; i < n; ++i) {
    const float s = std::max(state.density[i], 1.0F);
    state.projectedPressure[i] = static_cast<float>(kStiffness) * (std::pow(s, 7.0F) - 1);
  }
  press::push(state);
  std::vector<Vec3d> pushes(n);
  for (std::size_t i = 0; i < n; ++i)
    pushes[state.particles.id[i]] =
        ((state.projection.velocity[i].xyz() - state.particles.velocity[i].xyz()) / state.timeStep)
            .cast<double>();
  double scale = 0;
  for (const Vec3d& push : pushes) scale = std::max(scale, push.norm());
  ASSERT_GT(scale, 1);
  constexpr double kWay = 5e-4;
  for (const std::uint32_t id : {0U, 2U, 14U, 86U, 215U, 123U}) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto moved = [&](double way) {
        water.places()[id][axis] += way;
        water.look();
        const double found = energy();
        water.places()[id][axis] -= way;
        return found;
      };
      const double slope = (moved(kWay) - moved(-kWay)) / (2 * kWay);
      EXPECT_NEAR(pushes[id][axis], -slope, 0.02 * scale) << id << " " << axis;
    }
  }
}

// s + dt ds/dt within the tolerance, ds/dt by brute force over all pairs.
TEST(SolverRate, OfDensityIsWithinTheToleranceAfterDfsph) {
  SqueezedWater water(SolverMethod::dfsph);
  StepState& state = water.state();
  state.parameters.maxIterations = state.parameters.maxPressureIterations = 400;
  stages::pressFreeOfDivergence(state);
  EXPECT_GT(state.iterations, state.parameters.minIterations);
  EXPECT_LT(state.iterations, 400);
  const double h = static_cast<double>(state.supportRadius);
  const auto n = state.particles.size();
  double left = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d x = state.particles.position[i].xyz().cast<double>();
    const Vec3d v = state.particles.velocity[i].xyz().cast<double>();
    double rate = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const Vec3d offset = x - state.particles.position[j].xyz().cast<double>();
      const double r = offset.norm();
      if (j == i || r >= h) continue;
      const auto slope = static_cast<double>(WendlandC2::derivative(static_cast<float>(r / h)));
      rate += static_cast<double>(state.lattice.massRatio) * slope / h *
              offset.dot(v - state.particles.velocity[j].xyz().cast<double>()) / r;
    }
    const float gamma = state.gamma[i];
    if (state.wallSlot[i] != FluidState::kNoWall) {
      const Vec3d gradient = state.wallSlots[state.wallSlot[i]].sample.gradient.cast<double>() / h;
      rate -= static_cast<double>(state.density[i] * state.densityGammaSlope(gamma)) * gradient.dot(v);
    }
    rate /= static_cast<double>(state.densityGamma(gamma));
    left +=
        std::max(static_cast<double>(state.density[i] - 1) + static_cast<double>(state.timeStep) * rate, 0.0);
  }
  EXPECT_LE(left / static_cast<double>(n), 1.01 * state.parameters.tolerance);
}

// Water at rest on which gravity has acted for a step, of which the floor has taken its part: before that
// nothing moved, so the first solve has nothing to do, and the second is told not to.
TEST(SolverDivergence, IsThatOfTheVelocitiesThatTheStepBeforeHasLeft) {
  SqueezedWater water(SolverMethod::dfsph);
  StepState& state = water.state();
  state.parameters.minIterations = 0;
  state.parameters.tolerance = 0.99;
  state.gravity = {0, -9.81F, 0};
  const Vec3f gain = state.timeStep * state.gravity;
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    const bool onFloor = state.particles.position[i].y < 0.9F * static_cast<float>(kSpacing);
    state.before.velocity[i] = Float4(gain);
    state.particles.velocity[i] = Float4(onFloor ? Vec3f(Vec3f::Zero()) : gain);
  }
  stages::pressFreeOfDivergence(state);
  for (const float pressure : state.projectedPressure) EXPECT_EQ(pressure, 0);
}

TEST(SolverDivergence, ThatIsLeftIsNoted) {
  Scene scene = solvedBy(smallDamBreak(), SolverMethod::dfsph);
  scene.solver.divergenceTolerance = 0;
  scene.solver.maxPressureIterations = 1;
  Simulation simulation(scene, 1);
  for (int k = 0; k < 20; ++k) simulation.advanceFrame();
  const auto& events = simulation.statistics().trouble;
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const auto& event) {
    return event.kind == "not_converged" && event.detail.find("divergence") != std::string::npos;
  }));
}

// "cfl": 0 frees the step of the speed of particles, not of that of sound, beyond which it is not stable.
TEST(SolverSteps, OfWcsphKeepToSoundWithoutTheCflRule) {
  Scene scene = solvedBy(stillTank({4, 4, 4}), SolverMethod::wcsph);
  scene.solver.cfl = 0;
  scene.solver.timeStep = 0.01;
  scene.solver.wcsph.soundSpeed = 45;
  Simulation simulation(scene, 1);
  simulation.advanceFrame();
  EXPECT_EQ(simulation.statistics().steps, std::ceil(0.01 * 45 / (0.4 * 2.25 * kSpacing)));
}

// A pair flies apart with the same speed, however short the steps that sound asks for.
TEST(SolverEffects, ArtificialPressureDoesNotGrowWithShorterSteps) {
  const auto speed = [](double sound) {
    Scene scene = emptyScene();
    addFluid(scene, Vec3d::Zero(), {2 * kSpacing, kSpacing, kSpacing});
    scene.effects = effectsOf(R"({"artificial_pressure": {"delta_q": 0.5, "k": 0.01}})");
    scene = solvedBy(scene, SolverMethod::wcsph);
    scene.solver.wcsph.soundSpeed = sound;
    Simulation simulation(scene, 1);
    simulation.advanceFrame();
    EXPECT_EQ(simulation.view().velocities.size(), 2U);
    return simulation.statistics().maxSpeed;
  };
  const double inOne = speed(1);
  EXPECT_GT(inOne, 0);
  EXPECT_NEAR(speed(90) / inOne, 1, 0.1);
}

Scene parsedWith(const std::string& solver) {
  return parseScene(R"({"format": 1, "name": "n", "particle_spacing": 0.1,
    "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [1, 1, 1]}],
    "boundary": {"surfaces": []}, "solver": )" +
                        solver + "}",
                    "test.json");
}

TEST(SolverKeys, HaveDefaultsOfTheMethod) {
  const SolverParameters its = parsedWith(R"({"method": "pcisph", "tolerance": 0.005})").solver;
  EXPECT_EQ(its.kernel, KernelType::wendlandC2);
  EXPECT_EQ(its.minIterations, 3);
  EXPECT_EQ(its.tolerance, 0.005);
  const SolverParameters weakly = parsedWith(R"({"method": "wcsph", "wcsph": {"compression": 0.02}})").solver;
  EXPECT_EQ(weakly.wcsph.compression, 0.02);
  EXPECT_EQ(weakly.wcsph.viscosity, 0.08);
  EXPECT_EQ(parsedWith("{}").solver.method, SolverMethod::pbf);
}

TEST(SolverKeys, SayWhatDoesNotBelongToTheMethod) {
  const auto warned = [](const std::string& solver, const std::string& key) {
    const std::vector<std::string> warnings = parsedWith(solver).warnings;
    return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
      return warning.find("/solver/" + key) != std::string::npos;
    });
  };
  EXPECT_TRUE(warned(R"({"method": "dfsph", "wcsph": {}})", "wcsph"));
  EXPECT_FALSE(warned(R"({"method": "wcsph", "wcsph": {}})", "wcsph"));
  const std::string ofPbf = R"("tolerance": 0.03, "min_iterations": 2)";
  EXPECT_TRUE(warned(R"({"method": "dfsph", )" + ofPbf + "}",
                     "tolerance: 0.03 is that of the scene; dfsph's own is 0.001"));
  EXPECT_TRUE(warned(R"({"method": "pcisph", )" + ofPbf + "}",
                     "min_iterations: 2 is that of the scene; pcisph's own is 3"));
  EXPECT_FALSE(warned(R"({"method": "dfsph", )" + ofPbf + "}", "min_iterations"));
  EXPECT_FALSE(warned(R"({"method": "dfsph", "tolerance": 0.0005})", "tolerance"));
  EXPECT_FALSE(warned(R"({"method": "wcsph", )" + ofPbf + "}", "tolerance")) << "it has no iterations";
  EXPECT_FALSE(warned("{" + ofPbf + "}", "tolerance"));
  EXPECT_TRUE(warned(R"({"method": "dfsph", "velocity_step": "projection"})", "velocity_step"));
  try {
    static_cast<void>(parsedWith(R"({"method": "wcsph", "kernel": "poly6"})"));
    ADD_FAILURE() << "poly6 was accepted";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("/solver/method"), std::string::npos) << text;
    EXPECT_NE(text.find("wendland_c2"), std::string::npos) << text;
  }
}

}  // namespace solver_methods_test
}  // namespace migiwa
