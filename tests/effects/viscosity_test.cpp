// Kinematic viscosity against the decay of a shear wave, exp(-nu k^2 t), and against what it must conserve;
// affine XSPH against the fields that it must spare and the noise that it must damp.
#include <numbers>

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "tests/support/free_fluid.h"
#include "tests/support/moments.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace viscosity_test {

using namespace migiwa::testing;

/// A cube of water, `kSide` particles an axis, about the origin, after it was stirred in a tank: in no order.
constexpr int kSide = 24;
std::vector<Vec3f> stirredCube() {
  const double size = kSide * kSpacing;
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      for (int z = 0; z < 4; ++z) {
        const Vec3d corner = size / 4 * Vec3d(x, y, z);
        addFluid(scene, corner, corner + Vec3d::Constant(size / 4),
                 {std::sin(1 + 3 * y + 5 * z), std::sin(2 + 4 * x - z), std::sin(3 * y + 7 * x)});
      }
    }
  }
  addTank(scene, Vec3d::Zero(), {size, 1.2 * size, size});
  addViscosity(scene);
  Simulation simulation(scene);
  while (simulation.time() < 0.6) simulation.advanceFrame();
  std::vector<Vec3f> places;
  for (const Float4& p : simulation.view().positions)
    places.emplace_back(p.xyz() - Vec3f::Constant(static_cast<float>(0.5 * size)));
  return places;
}

/// Decay rate of a shear wave over nu k^2, in a fluid that stays where it is, from what is far from its
/// surface.
double decayOverExpected(const std::vector<Vec3f>& places, const Vec3f& along, const Vec3f& across) {
  constexpr int kSteps = 8;
  constexpr double kViscosity = 0.1;
  const float wave = 2 * std::numbers::pi_v<float> / (18 * static_cast<float>(kSpacing));
  const auto profile = [&](const Vec3f& x) { return std::sin(wave * along.dot(x)); };
  FreeFluid fluid(places, [&](const Vec3f& x) { return Vec3f(profile(x) * across); });
  StepState& state = fluid.state();
  const auto amplitude = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < state.particles.size(); ++i) {
      const Vec3f x = state.particles.position[i].xyz();
      if (static_cast<double>(x.cwiseAbs().maxCoeff()) > 0.25 * kSide * kSpacing) continue;
      sum += static_cast<double>(across.dot(state.particles.velocity[i].xyz()) * profile(x));
    }
    return sum;
  };
  state.timeStep = 0.001F;
  const double before = amplitude();
  for (int k = 0; k < kSteps; ++k) fluid.changeVelocities(R"({"viscosity": {"xsph": 0, "kinematic": 0.1}})");
  const double squared = std::pow(static_cast<double>(wave), 2);
  return std::log(before / amplitude()) / (kViscosity * squared * kSteps * 0.001);
}

TEST(KinematicViscosity, AShearWaveDecaysAsItMust) {
  const std::vector<Vec3f> places = stirredCube();
  const Vec3f directions[][2] = {
      {{1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 0, 0}}, {{1, 1, 0}, {1, -1, 0}}, {{1, 2, 3}, {3, 0, -1}}};
  for (const auto& [along, across] : directions)
    EXPECT_NEAR(decayOverExpected(places, along.normalized(), across.normalized()), 1, 0.03)
        << along.transpose();
}

// Translation, rotation, shear and expansion at once, surfaces included. Edges and corners of the cube have
// too few neighbours to tell, and so have drops at the surface of the stirred one.
TEST(AffineXsph, SparesWhatIsLinearInSpace) {
  Eigen::Matrix3f gradient;
  gradient << 0.3F, -2, 0.7F, 1.5F, -0.8F, 0.4F, -0.2F, 0.9F, 0.6F;
  const auto field = [&](const Vec3f& x) { return Vec3f(gradient * x + Vec3f(1, -2, 3)); };
  for (const bool stirred : {true, false}) {
    FreeFluid fluid(stirred ? stirredCube() : latticePlaces(14, 0.4F), field);
    const Particles& particles = fluid.state().particles;
    fluid.changeVelocities(R"({"viscosity": {"xsph": 0, "affine_xsph": 1}})");
    float half = 0;
    for (const Float4& p : particles.position) half = std::max(half, std::abs(p.x));
    const float rim = half - 4.5F * static_cast<float>(kSpacing);
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Vec3f x = particles.position[i].xyz();
      if ((x.cwiseAbs().array() > rim).count() > 1 || (stirred && x.y() > rim)) continue;
      EXPECT_LT((particles.velocity[i].xyz() - field(x)).norm(), 5e-5F) << x.transpose();
    }
    // What plain XSPH does to the same field.
    fluid.changeVelocities(R"({"viscosity": {"xsph": 1}})");
    float most = 0;
    for (std::size_t i = 0; i < particles.size(); ++i)
      most = std::max(most, (particles.velocity[i].xyz() - field(particles.position[i].xyz())).norm());
    EXPECT_GT(most, 0.01F);
  }
}

// A field that differs from particle to particle loses most of its energy in ten steps, a wave as long as the
// cube next to nothing, and momentum stays.
TEST(AffineXsph, DampsNoiseSparesWavesAndKeepsMomentum) {
  const std::vector<Vec3f> places = stirredCube();
  constexpr float kWave = std::numbers::pi_v<float> / static_cast<float>(kSide * kSpacing);
  const auto noise = [](const Vec3f& x) {
    return Vec3f(std::sin(9000 * x.x() + 7000 * x.y()), std::cos(8000 * x.z() - 6000 * x.x()),
                 std::sin(9500 * x.y() + 5000 * x.z()));
  };
  const auto wave = [](const Vec3f& x) { return Vec3f(0, std::sin(kWave * x.x()), 0); };
  const auto kept = [&](const auto& field) {
    FreeFluid fluid(places, field);
    const Particles& particles = fluid.state().particles;
    const Moments before = momentsOf(particles.position, particles.velocity);
    for (int k = 0; k < 10; ++k) fluid.changeVelocities(R"({"viscosity": {"xsph": 0, "affine_xsph": 0.3}})");
    const Moments after = momentsOf(particles.position, particles.velocity);
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-5 * 1000 * before.speed);
    return after.kinetic / before.kinetic;
  };
  EXPECT_LT(kept(noise), 0.2);
  EXPECT_NEAR(kept(wave), 1, 1e-3);
}

TEST(KinematicViscosity, MomentumAndAngularMomentumStay) {
  FreeFluid lattice(latticePlaces(10, 0.4F), [](const Vec3f& x) {
    return Vec3f(std::sin(40 * x.y()), x.x() - std::cos(31 * x.z()), std::sin(23 * x.x()));
  });
  const Particles& particles = lattice.state().particles;
  const Moments before = momentsOf(particles.position, particles.velocity);
  for (const char* viscosity : {R"({"viscosity": {"xsph": 0, "kinematic": 0.05}})",
                                R"({"viscosity": {"xsph": 0, "kinematic": 100}})"}) {
    lattice.changeVelocities(viscosity);
    const Moments after = momentsOf(particles.position, particles.velocity);
    EXPECT_LT((after.momentum - before.momentum).norm(), 2e-6 * 1000 * before.speed);
    EXPECT_LT((after.angular - before.angular).norm(), 2e-6 * 1000 * before.speed);
    EXPECT_LT(after.kinetic, 0.9 * before.kinetic);
  }
  // What 100 m^2/s leaves of it in 5 ms is the motion of a rigid body: the kinetic energy is what its
  // momentum and its angular momentum about the centre ask for.
  const Moments after = momentsOf(particles.position, particles.velocity);
  const double n = static_cast<double>(particles.size());
  const Vec3d spin = after.angular - cross(after.centre, after.momentum);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const Float4& p : particles.position) {
    const Vec3d r = p.xyz().cast<double>() - after.centre;
    inertia += r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose();
  }
  const double rigid =
      0.5 * after.momentum.squaredNorm() / n + 0.5 * spin.dot(Vec3d(inertia.ldlt().solve(spin)));
  EXPECT_NEAR(after.kinetic, rigid, 1e-3 * before.kinetic);
}

TEST(KinematicViscosity, AFlowingShearWaveDecaysInAWholeRun) {
  // Layers that slide along each other, two waves of them, free on all sides; the waves are read where the
  // surface is far.
  constexpr int kLayers = 24;
  constexpr double kViscosity = 0.05, kUntil = 0.15;
  const double wave = 2 * std::numbers::pi / (0.5 * kLayers * kSpacing);
  Scene scene = emptyScene();
  scene.solver.timeStep = 0.0025;
  for (int k = 0; k < kLayers; ++k) {
    const double x = k * kSpacing;
    addFluid(scene, {x, -0.9, -0.5}, {x + kSpacing, 0.9, 0.5},
             {0, 0.01 * std::cos(wave * (x + 0.5 * kSpacing)), 0});
  }
  scene.effects = effectsOf(R"({"viscosity": {"xsph": 0, "kinematic": 0.05}})");
  Simulation simulation(scene);
  const auto amplitude = [&] {
    double sum = 0;
    const FrameView view = simulation.view();
    for (std::size_t i = 0; i < view.positions.size(); ++i) {
      const Vec3d x = view.positions[i].xyz().cast<double>();
      if (std::max(std::abs(x.y()), std::abs(x.z())) > 0.2) continue;
      sum += static_cast<double>(view.velocities[i].y) * std::cos(wave * x.x());
    }
    return sum;
  };
  const double before = amplitude();
  while (simulation.time() < kUntil - 1e-9) simulation.advanceFrame();
  // Along the axes of its lattice, and in so short a wave, the fluid resists by some percent less.
  const double rate = std::log(before / amplitude()) / simulation.time();
  EXPECT_NEAR(rate / (kViscosity * wave * wave), 0.95, 0.05);
}

}  // namespace viscosity_test
}  // namespace migiwa
