// Vorticity confinement: nothing is pushed or turned as a whole, a solid rotation stays one, and a vortex
// lasts longer than without.
#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "tests/support/free_fluid.h"
#include "tests/support/moments.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace vorticity_confinement_test {

using namespace migiwa::testing;

constexpr float kCore = 0.2F;  ///< of the vortex (m)

/// A Gaussian vortex about the z axis: vorticity 2 exp(-r^2 / core^2) (1/s).
Vec3f vortex(const Vec3f& x) {
  const float square = x.x() * x.x() + x.y() * x.y();
  const float turn = square > 0 ? kCore * kCore / square * -std::expm1(-square / (kCore * kCore)) : 1;
  return {-turn * x.y(), turn * x.x(), 0};
}

TEST(VorticityConfinement, MomentumAndAngularMomentumStay) {
  FreeFluid lattice(latticePlaces(14, 0.3F), [](const Vec3f& x) {
    return Vec3f(vortex(x + Vec3f(0.1F, 0.05F, 0)) + Vec3f(0.3F, 0.1F * std::sin(9 * x.x()), 0.2F * x.y()));
  });
  const Particles& particles = lattice.state().particles;
  const Moments before = momentsOf(particles.position, particles.velocity);
  std::vector<Float4> velocities = particles.velocity;
  lattice.changeVelocities(R"({"vorticity_confinement": {"strength": 20}})");
  double change = 0;
  for (std::size_t i = 0; i < velocities.size(); ++i)
    change += static_cast<double>((particles.velocity[i].xyz() - velocities[i].xyz()).norm());
  ASSERT_GT(change, 1) << "it acts";
  const Moments after = momentsOf(particles.position, particles.velocity);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-4 * change);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-4 * change);
}

TEST(VorticityConfinement, TheForceOnAVortexIsThatOfTheFormula) {
  // About the axis N points inwards: N x w = |w| along the rotation, with what that adds to the rotation as a
  // whole taken out again.
  constexpr int kSide = 20;
  constexpr double kStrength = 2;
  FreeFluid lattice(latticePlaces(kSide, 0), vortex);
  StepState& state = lattice.state();
  const Particles& particles = state.particles;
  const std::vector<Float4> velocities = particles.velocity;
  lattice.changeVelocities(R"({"vorticity_confinement": {"strength": 2}})");
  // Torque and moment of inertia of the expected force, particle by particle.
  const auto expected = [&](const Vec3d& x) {
    const double square = x.head<2>().squaredNorm();
    const double vorticity = 2 * std::exp(-square / static_cast<double>(kCore * kCore));
    const double r = std::sqrt(square);
    return Vec3d(vorticity / r * Vec3d(-x.y(), x.x(), 0));
  };
  double torque = 0, inertia = 0;
  for (const Float4& p : particles.position) {
    const Vec3d x = p.xyz().cast<double>();
    torque += cross(x, expected(x)).z(), inertia += x.head<2>().squaredNorm();
  }
  double error = 0, scale = 0;
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    const Vec3d x = particles.position[i].xyz().cast<double>();
    // Where differences over the support radius are the gradients: not at the axis, nor at the surface.
    const double r = x.head<2>().norm();
    if (r < 0.12 || r > 0.3 || std::abs(x.z()) > 0.3) continue;
    const Vec3d net = cross(Vec3d(0, 0, torque / inertia), x);
    const Vec3d force = kStrength * static_cast<double>(state.supportRadius) * (expected(x) - net);
    const Vec3d found = (particles.velocity[i].xyz() - velocities[i].xyz()).cast<double>() /
                        static_cast<double>(state.timeStep);
    error += (found - force).squaredNorm(), scale += force.squaredNorm();
  }
  EXPECT_LT(std::sqrt(error / scale), 0.15);
}

double energyAfter(const std::string& effects, Vec3d* spin = nullptr) {
  Scene scene = emptyScene();
  scene.effects = effectsOf(effects);
  // A vortex of columns, each with its own velocity.
  for (int x = -10; x < 10; ++x) {
    for (int y = -10; y < 10; ++y) {
      const Vec3d from = kSpacing * Vec3d(x, y, -4);
      const Vec3d middle = from + 0.5 * kSpacing * Vec3d(1, 1, 0);
      addFluid(scene, from, from + kSpacing * Vec3d(1, 1, 8),
               vortex(Vec3f(middle.cast<float>().x(), middle.cast<float>().y(), 0)).cast<double>());
    }
  }
  Simulation simulation(scene, 2);
  while (simulation.time() < 0.5) simulation.advanceFrame();
  const Moments moments = momentsOf(simulation.view());
  if (spin != nullptr) *spin = moments.angular;
  return moments.kinetic;
}

TEST(VorticityConfinement, AVortexLastsLonger) {
  Vec3d spinWithout, spinWith;
  const double without = energyAfter(R"({"viscosity": {"xsph": 0.1}})", &spinWithout);
  const double with =
      energyAfter(R"({"viscosity": {"xsph": 0.1}, "vorticity_confinement": {"strength": 2}})", &spinWith);
  EXPECT_GT(with, 1.05 * without);
  EXPECT_LT((spinWith - spinWithout).norm(), 0.01 * spinWithout.norm());
}

}  // namespace vorticity_confinement_test
}  // namespace migiwa
