// Velocities by projection against closed forms: pressure of water at rest, a standing wave, free fall; and
// what every step has to keep: momentum of flight, determinism, state.
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"
#include "core/simulation/measures.h"
#include "core/simulation/simulation.h"
#include "core/simulation/state.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace projection_test {

using namespace migiwa::testing;

Scene projected(Scene scene) {
  scene.solver.takeVelocities(VelocityStep::projection);
  scene.effects.clear();
  return scene;
}

/// A tank 1 m long and 0.2 m wide, water to 0.5 + 0.05 cos(pi x) m.
Scene standingWave(double spacing, double timeStep) {
  Scene scene = emptyScene();
  scene.particleSpacing = spacing;
  scene.solver.timeStep = timeStep;
  scene.gravity = {0, -9.81, 0};
  addTank(scene, Vec3d::Zero(), {1, 1, 0.2});
  const long columns = std::lround(1 / spacing);
  for (long k = 0; k < columns; ++k) {
    const double left = static_cast<double>(k) * spacing;
    const double height = 0.5 + 0.05 * std::cos(std::numbers::pi * (left + 0.5 * spacing));
    addFluid(scene, {left, 0, 0}, {left + spacing, spacing * std::round(height / spacing), 0.2});
  }
  return scene;
}

double meanX(const FrameView& view) {
  double sum = 0;
  for (const Float4& p : view.positions) sum += static_cast<double>(p.x);
  return sum / static_cast<double>(view.positions.size()) - 0.5;
}

struct Swing {
  std::vector<double> times, heights;  ///< of the extrema
};

/// Extrema of the centre of mass, each the largest deviation within 0.3 s around it.
Swing swing(Simulation& simulation, double duration) {
  std::vector<double> times, values;
  const double dt = simulation.scene().solver.timeStep;
  for (double t = dt; t < duration; t += dt) {
    simulation.advanceFrame();
    times.push_back(t), values.push_back(meanX(simulation.view()));
  }
  Swing found;
  const auto reach = static_cast<std::size_t>(std::lround(0.3 / dt));
  for (std::size_t k = reach; k + reach < values.size(); ++k) {
    bool extreme = true;
    for (std::size_t other = k - reach; other <= k + reach; ++other)
      extreme = extreme && std::abs(values[other]) <= std::abs(values[k]);
    if (extreme && (found.times.empty() || times[k] > found.times.back() + 0.3))
      found.times.push_back(times[k]), found.heights.push_back(values[k]);
  }
  return found;
}

// Linear theory: T = 2 pi / sqrt(g k tanh(k d)) with k = pi / 1 m, d = 0.5 m, and nothing is lost.
TEST(Projection, AStandingWaveKeepsItsHeightAndPeriod) {
  constexpr double kPi = std::numbers::pi;
  const double period = 2 * kPi / std::sqrt(9.81 * kPi * std::tanh(0.5 * kPi));
  for (const double timeStep : {0.0025, 0.005, 0.01}) {
    SCOPED_TRACE(timeStep);
    Simulation simulation(projected(standingWave(0.05, timeStep)));
    const Swing found = swing(simulation, 4.4);
    ASSERT_GE(found.times.size(), 5U);
    EXPECT_NEAR((found.times[4] - found.times[0]) / 2, period, 0.04 * period);
    const double kept = std::sqrt(found.heights[4] / found.heights[0]);
    EXPECT_GT(kept, 0.75);
    EXPECT_LT(kept, 1.02);
    EXPECT_FALSE(simulation.statistics().failed());
  }
}

// p = rho g z, at the floor of a tank a metre deep as in one of half a metre, in every frame.
TEST(Projection, WaterAtRestHasThePressureOfItsDepth) {
  for (const int layers : {10, 20}) {
    SCOPED_TRACE(layers);
    Simulation simulation(projected(stillTank({8, layers, 8})));
    simulation.watchPressure(true);
    const double depth = kSpacing * layers;
    double errors = 0, squares = 0;
    long samples = 0;
    for (int frame = 0; frame < 400; ++frame) {
      simulation.advanceFrame();
      if (frame < 200) continue;
      const FrameView view = simulation.view();
      for (std::size_t i = 0; i < view.positions.size(); ++i) {
        const double y = static_cast<double>(view.positions[i].y);
        const double error = static_cast<double>(view.pressure[i]) - 1000 * 9.81 * (depth - y);
        errors += error, squares += error * error, ++samples;
      }
    }
    errors /= static_cast<double>(samples), squares /= static_cast<double>(samples);
    // Of the weight of a layer; half of one would be missing, were the surface at the outermost centres.
    EXPECT_LT(std::abs(errors), 0.15 * 1000 * 9.81 * kSpacing);
    EXPECT_LT(std::sqrt(squares - errors * errors), 0.015 * 1000 * 9.81 * depth);
  }
}

// As high as it was filled in, and at rest.
TEST(Projection, WaterAtRestStaysAtRestAndFillsItsTank) {
  Simulation simulation(projected(stillTank({16, 15, 16})));
  const SettledMeasures settled = runUntil(simulation, 2.5);
  EXPECT_NEAR(*settled.height / *settled.expectedHeight, 1, 0.005);
  EXPECT_GE(*settled.edgeCrowding, 0.9);
  EXPECT_LE(*settled.edgeCrowding, 1.10);
  EXPECT_LT(*settled.rmsSpeed, 0.008);
  EXPECT_FALSE(simulation.statistics().failed());
}

// At rest the pressure stays what it is.
TEST(Projection, ThePressureOfWaterAtRestDoesNotFlicker) {
  constexpr int kLayers = 15;
  Simulation simulation(projected(stillTank({8, kLayers, 8})));
  simulation.watchPressure(true);
  double sum = 0, squares = 0;
  constexpr int kFrames = 400;
  for (int frame = 0; frame < 2 * kFrames; ++frame) {
    simulation.advanceFrame();
    if (frame < kFrames) continue;
    const FrameView view = simulation.view();
    double pressure = 0;
    int count = 0;
    for (std::size_t i = 0; i < view.positions.size(); ++i)
      if (static_cast<double>(view.positions[i].y) < kSpacing)
        pressure += static_cast<double>(view.pressure[i]), ++count;
    ASSERT_GT(count, 0);
    pressure /= count;
    sum += pressure, squares += pressure * pressure;
  }
  const double mean = sum / kFrames, deviation = std::sqrt(squares / kFrames - mean * mean);
  EXPECT_GT(mean, 1000 * 9.81 * kSpacing * (kLayers - 1));
  EXPECT_LT(deviation, 0.01 * mean);
}

// Water at rest, let go without a pressure. Steepest descent, the same without the direction before, takes 14
// iterations to leave a fifth of the divergence.
TEST(Projection, APressureFromNothingTakesFewIterations) {
  Simulation simulation(projected(stillTank({4, 20, 4})));
  simulation.advanceFrame();
  ASSERT_EQ(simulation.statistics().steps, 1);
  EXPECT_GE(simulation.statistics().pressureIterationSum, 1);
  EXPECT_LE(simulation.statistics().pressureIterationSum, 7);
}

// As for velocities from positions: x_n = x_0 + n dt v_0 + dt^2 g n (n + 1) / 2, of a block and of a particle
// without neighbours.
TEST(Projection, FreeFallIsThatOfSymplecticEuler) {
  for (const double side : {0.25, 0.05}) {
    SCOPED_TRACE(side);
    Scene scene = projected(emptyScene());
    scene.gravity = {0, -9.81, 0};
    addFluid(scene, {0, 0, 0}, {side, side, side}, {0.5, 1, 0});
    Simulation simulation(scene, 1);
    const std::vector<Float4> start(simulation.view().positions.begin(), simulation.view().positions.end());
    ASSERT_EQ(start.size(), side > 0.1 ? 125U : 1U);
    constexpr int kSteps = 60;
    for (int k = 0; k < kSteps; ++k) simulation.advanceFrame();
    const double dt = scene.solver.timeStep;
    const Vec3d way =
        kSteps * dt * Vec3d(0.5, 1, 0) + dt * dt * scene.gravity * (0.5 * kSteps * (kSteps + 1));
    Vec3d moved = Vec3d::Zero();
    for (const Float4& p : simulation.view().positions) moved += p.xyz().cast<double>();
    for (const Float4& p : start) moved -= p.xyz().cast<double>();
    moved /= static_cast<double>(start.size());
    EXPECT_LT((moved - way).norm(), 5e-5);
  }
}

std::uint64_t hashAfter(const Scene& scene, int frames, int threads) {
  Simulation simulation(scene, threads);
  for (int k = 0; k < frames; ++k) simulation.advanceFrame();
  return simulation.stateHash();
}

TEST(Projection, TheStateIsTheSameForAnyNumberOfThreads) {
  const Scene scene = projected(smallDamBreak());
  const std::uint64_t alone = hashAfter(scene, 60, 1);
  EXPECT_EQ(hashAfter(scene, 60, 2), alone);
  EXPECT_EQ(hashAfter(scene, 60, 5), alone);
}

TEST(Projection, ASavedStateGoesOnAsIfNothingHadHappened) {
  const Scene scene = projected(smallDamBreak());
  Simulation straight(scene, 1);
  for (int k = 0; k < 30; ++k) straight.advanceFrame();
  const StateImage image = StateImage::of(straight);
  Simulation resumed(scene, 2);
  image.restore(resumed);
  for (int k = 0; k < 30; ++k) straight.advanceFrame(), resumed.advanceFrame();
  EXPECT_EQ(straight.stateHash(), resumed.stateHash());
}

// A state without a pressure of its own goes on with one; without, it goes on as ever.
TEST(Projection, CanBeSwitchedOnAndOffInARun) {
  const Scene scene = projected(smallDamBreak());
  Scene positions = scene;
  positions.solver.velocityStep = VelocityStep::positions;
  Simulation simulation(positions, 1);
  for (int k = 0; k < 20; ++k) simulation.advanceFrame();
  const StateImage image = StateImage::of(simulation);
  Simulation switched(scene, 1), same(positions, 1);
  image.restore(switched), image.restore(same);
  for (int k = 0; k < 20; ++k) simulation.advanceFrame(), switched.advanceFrame(), same.advanceFrame();
  EXPECT_EQ(same.stateHash(), simulation.stateHash());
  EXPECT_NE(switched.stateHash(), simulation.stateHash());
  EXPECT_FALSE(switched.statistics().failed());
  Simulation back(positions, 1);
  StateImage::of(switched).restore(back);
  for (int k = 0; k < 20; ++k) back.advanceFrame();
  EXPECT_FALSE(back.statistics().failed());
}

TEST(Projection, ParticlesThatComeAndGoKeepTheirPressures) {
  Scene scene = projected(emptyScene());
  scene.gravity = {0, -9.81, 0};
  addTank(scene, Vec3d::Zero(), {0.6, 0.8, 0.6});
  addFluid(scene, Vec3d::Zero(), {0.6, 0.3, 0.6});
  Emitter emitter;
  emitter.shape = MouthShape::rectangle;
  emitter.center = {0.3, 0.7, 0.3};
  emitter.direction = {0, -1, 0};
  emitter.size = {0.2, 0.2};
  emitter.speed = 1;
  scene.emitters.push_back(emitter);
  Drain drain;
  drain.min = {0, 0.32, 0}, drain.max = {0.6, 0.4, 0.6};
  scene.drains.push_back(drain);
  Simulation simulation(scene, 2);
  for (int k = 0; k < 200; ++k) simulation.advanceFrame();
  const RunStatistics& run = simulation.statistics();
  EXPECT_FALSE(run.failed());
  EXPECT_EQ(run.lostParticles, 0);
  EXPECT_GT(run.fluid.drained(), 100);
  EXPECT_LT(run.maxSpeed, 5);
}

Scene parsedWith(const std::string& solver) {
  return parseScene(R"({"format": 1, "name": "n", "particle_spacing": 0.1,
    "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [1, 1, 1]}],
    "boundary": {"surfaces": []}, "solver": )" +
                        solver + "}",
                    "test.json");
}

// One kernel has to serve density, gamma and forces alike.
TEST(Projection, AsksForAKernelWhoseOwnGradientMovesParticles) {
  try {
    static_cast<void>(parsedWith(R"({"velocity_step": "projection", "kernel": "poly6"})"));
    ADD_FAILURE() << "poly6 was accepted";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("/solver/velocity_step"), std::string::npos) << text;
    EXPECT_NE(text.find("wendland_c2"), std::string::npos) << text;
    EXPECT_NE(text.find("poly6"), std::string::npos) << text;
  }
}

TEST(Projection, IsWhatASceneHasUnlessItAsksForWhatDoesNotGoWithIt) {
  const SolverParameters usual = parsedWith("{}").solver;
  EXPECT_EQ(usual.velocityStep, VelocityStep::projection);
  EXPECT_EQ(usual.kernel, KernelType::wendlandC2);
  EXPECT_EQ(usual.supportRatio, 2.25);
  EXPECT_EQ(usual.tolerance, 0.003);
  EXPECT_EQ(usual.minIterations, 1);
  const SolverParameters given =
      parsedWith(R"({"tolerance": 0.01, "kernel": "cubic_spline", "support_ratio": 2, "min_iterations": 3})")
          .solver;
  EXPECT_EQ(given.velocityStep, VelocityStep::projection);
  EXPECT_EQ(given.kernel, KernelType::cubicSpline);
  EXPECT_EQ(given.supportRatio, 2);
  EXPECT_EQ(given.tolerance, 0.01);
  EXPECT_EQ(given.minIterations, 3);
  for (const char* solver :
       {R"({"velocity_step": "positions"})", R"({"kernel": "poly6"})", R"({"position_step": "paper"})"}) {
    SCOPED_TRACE(solver);
    const SolverParameters positions = parsedWith(solver).solver;
    EXPECT_EQ(positions.velocityStep, VelocityStep::positions);
    EXPECT_EQ(positions.kernel, KernelType::poly6);
    EXPECT_EQ(positions.supportRatio, 2);
    EXPECT_EQ(positions.tolerance, 0.01);
    EXPECT_EQ(positions.minIterations, 2);
  }
  const SolverParameters kept =
      parsedWith(R"({"velocity_step": "positions", "kernel": "wendland_c2"})").solver;
  EXPECT_EQ(kept.kernel, KernelType::wendlandC2);
  const char* const drop = R"({"format": 1, "particle_spacing": 0.1,
    "fluid": [{"shape": "sphere", "center": [0, 0, 0], "radius": 1}],
    "effects": {"surface_tension": {}}, "solver": %}})";
  const auto ofDrop = [&](const std::string& solver) {
    std::string text = drop;
    text.replace(text.find("%}"), 2, solver);
    return parseScene(text, "test.json").solver.velocityStep;
  };
  EXPECT_EQ(ofDrop("{}"), VelocityStep::positions);
  EXPECT_EQ(ofDrop(R"({"velocity_step": "projection"})"), VelocityStep::projection);
}

// The divergence does not see all noise. Without a viscosity against it this tank boils at 0.4 m/s; where
// density errors gather until their mean is the tolerance, the coarse one trembles at 0.1 m/s.
TEST(Projection, WaterWithoutAnyViscosityIsStillForLong) {
  for (const double tolerance : {0.003, 0.03}) {
    SCOPED_TRACE(tolerance);
    Scene scene = projected(stillTank({12, 12, 12}));
    scene.solver.tolerance = tolerance;
    Simulation simulation(scene);
    const SettledMeasures settled = runUntil(simulation, 8);
    EXPECT_LT(*settled.rmsSpeed, 0.012);
    EXPECT_TRUE(simulation.statistics().trouble.empty());
  }
}

// d v / dt = nu laplace v of layers that slide over each other, far from the sides of a falling block.
TEST(Projection, TheViscosityAgainstNoiseIsTheOneThatItStates) {
  constexpr int kCells = 20;
  constexpr double kSide = kCells * kSpacing, kSpeed = 0.1, kWave = 2 * std::numbers::pi / kSide;
  for (const double timeStep : {0.005, 0.00125}) {
    SCOPED_TRACE(timeStep);
    Scene scene = projected(emptyScene());
    scene.gravity = {0, 0, -9.81};
    scene.solver.timeStep = timeStep;
    for (int layer = 0; layer < kCells; ++layer) {
      const double low = layer * kSpacing;
      addFluid(scene, {0, low, 0}, {kSide, low + kSpacing, kSide},
               {kSpeed * std::sin(kWave * (low + 0.5 * kSpacing)), 0, 0});
    }
    Simulation simulation(scene);
    const auto inside = [&](const Float4& p) {
      const double z = static_cast<double>(p.z) - 0.5 * scene.gravity.z() * std::pow(simulation.time(), 2);
      return std::min({static_cast<double>(p.x), static_cast<double>(p.y), z}) > 0.25 &&
             std::max({static_cast<double>(p.x), static_cast<double>(p.y), z}) < 0.75;
    };
    const auto amplitude = [&] {
      double along = 0, square = 0;
      const FrameView view = simulation.view();
      for (std::size_t i = 0; i < view.positions.size(); ++i) {
        if (!inside(view.positions[i])) continue;
        const double form = std::sin(kWave * static_cast<double>(view.positions[i].y));
        along += form * static_cast<double>(view.velocities[i].x), square += form * form;
      }
      return along / square;
    };
    const double before = amplitude();
    while (simulation.time() < 0.1 - 1e-9) simulation.advanceFrame();
    const double fall = std::sqrt(2 * kSpacing / 9.81) / 2;  // half the time of a fall by a spacing
    const double viscosity = 0.2 * kSpacing * kSpacing / fall;
    EXPECT_NEAR(std::log(before / amplitude()) / (viscosity * kWave * kWave * simulation.time()), 1, 0.15);
  }
}

}  // namespace projection_test
}  // namespace migiwa
