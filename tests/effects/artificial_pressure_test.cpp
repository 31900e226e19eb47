// Artificial pressure spreads particles, and changes no momentum.
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "core/sph/kernels.h"
#include "tests/support/moments.h"
#include "tests/support/test_effects.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace artificial_pressure_test {

using namespace migiwa::testing;

/// Distance to the nearest other particle over the spacing: the percentile of all particles.
double nearestSpacing(const FrameView& view, double percentile) {
  std::vector<double> nearest;
  for (const Float4& p : view.positions) {
    double least = 1e9;
    for (const Float4& other : view.positions)
      if (&other != &p) least = std::min(least, static_cast<double>((other.xyz() - p.xyz()).norm()));
    nearest.push_back(least / kSpacing);
  }
  std::sort(nearest.begin(), nearest.end());
  return nearest[static_cast<std::size_t>(percentile * static_cast<double>(nearest.size() - 1))];
}

struct Collision {
  double spacing;
  Vec3d momentum, angular;
};

/// Two blocks after they have hit each other in free space.
Collision collide(const std::string& effects) {
  Scene scene = emptyScene();
  addFluid(scene, {0, 0, 0}, {0.4, 0.4, 0.4}, {1.5, 0, 0});
  addFluid(scene, {0.45, 0.1, 0.05}, {0.75, 0.4, 0.35}, {-2, 0.3, 0});
  scene.effects = effectsOf(effects);
  Simulation simulation(scene, 2);
  while (simulation.time() < 0.3) simulation.advanceFrame();
  const Moments moments = momentsOf(simulation.view());
  return {nearestSpacing(simulation.view(), 0.01), moments.momentum, moments.angular};
}

TEST(ArtificialPressure, ParticlesKeepTheirDistanceAndTheirMomentum) {
  const Collision without = collide("{}");
  const Collision with = collide(R"({"artificial_pressure": {}})");
  const Collision stronger = collide(R"({"artificial_pressure": {"k": 0.3}})");
  EXPECT_GT(with.spacing, without.spacing + 0.03);
  EXPECT_GT(stronger.spacing, with.spacing);
  const double scale = without.momentum.norm();
  EXPECT_LT((with.momentum - without.momentum).norm(), 1e-4 * scale);
  EXPECT_LT((with.angular - without.angular).norm(), 1e-3 * scale);
}

TEST(ArtificialPressure, APairAtDeltaQPartsAsFarAsEquation13Says) {
  // One step of one iteration on two particles that are at 0.2 h, far below the rest density.
  Scene scene = emptyScene();
  scene.solver.minIterations = scene.solver.maxIterations = 1;
  scene.solver.timeStep = 0.01;
  scene.solver.acceleration = Acceleration::none;
  const double gap = 0.2 * 2 * kSpacing;
  addFluid(scene, {0, 0, 0}, {kSpacing, kSpacing, kSpacing});
  addFluid(scene, {gap, 0, 0}, {gap + kSpacing, kSpacing, kSpacing}, Vec3d::Zero(), false);
  scene.effects = effectsOf(R"({"artificial_pressure": {"k": 0.1, "n": 4, "delta_q": 0.2}})");
  Simulation simulation(scene, 1);
  simulation.advanceFrame();
  const FrameView view = simulation.view();
  const double apart = static_cast<double>((view.positions[0].xyz() - view.positions[1].xyz()).norm());
  // Each moves by (m/rho0) s_corr grad W with Spiky's gradient, s_corr = -k over twice the lattice's squares.
  const RestingLattice lattice = restingLattice(KernelType::poly6, 2);
  const double slope = -45 / std::numbers::pi * 0.8 * 0.8;
  const double move = 2 * kSpacing * static_cast<double>(lattice.massRatio) * slope * -0.1 /
                      (2 * static_cast<double>(lattice.squaredGradients));
  EXPECT_NEAR(apart - gap, 2 * move, 1e-3 * move + 1e-6);
}

}  // namespace artificial_pressure_test
}  // namespace migiwa
