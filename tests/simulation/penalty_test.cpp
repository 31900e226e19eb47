// Walls that push by depth ("handling": "penalty"): what the paper's introduction holds against them, and
// what they keep nevertheless.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "core/simulation/statistics.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace penalty_test {

using namespace migiwa::testing;

Scene handled(Scene scene, std::string_view handling) {
  const auto names = handlingNames();
  const auto index = std::find(names.begin(), names.end(), handling) - names.begin();
  scene.boundary.handling = static_cast<BoundaryHandling>(index);
  return scene;
}

/// Over the spacing: how far, on the mean, the nearest particle is from those within a spacing of the floor.
double nearestAtFloor(const Simulation& simulation) {
  const auto positions = simulation.view().positions;
  double sum = 0;
  long count = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (static_cast<double>(positions[i].y) > kSpacing) continue;
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t j = 0; j < positions.size(); ++j)
      if (j != i) nearest = std::min(nearest, (positions[i].xyz() - positions[j].xyz()).norm());
    sum += static_cast<double>(nearest) / kSpacing;
    ++count;
  }
  return sum / static_cast<double>(count);
}

// Density falls short beside walls that add none, so that particles crowd there; with gamma they do not.
TEST(Penalty, CrowdsParticlesAtWallsAsThePaperSays) {
  const auto after = [](std::string_view handling) {
    Simulation simulation(handled(stillTank({8, 10, 8}), handling), 2);
    for (int k = 0; k < 200; ++k) simulation.advanceFrame();
    EXPECT_FALSE(simulation.statistics().failed());
    return nearestAtFloor(simulation);
  };
  const double corrected = after("gamma"), pushed = after("penalty");
  EXPECT_GT(corrected, 0.9);
  EXPECT_LT(pushed, 0.9 * corrected);
}

// A particle that a floor pushes by its depth comes to rest where the spring carries its weight:
// d = g / k = a quarter of a spacing over 40 layers.
TEST(Penalty, ALoneParticleRestsWhereTheSpringCarriesIt) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, {0, 0.1, 0}, {kSpacing, 0.1 + kSpacing, kSpacing});
  scene.surfaces.push_back(std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY()));
  Simulation simulation(handled(scene, "penalty"), 1);
  ASSERT_EQ(simulation.view().positions.size(), 1U);
  for (int k = 0; k < 400; ++k) simulation.advanceFrame();
  const auto height = static_cast<double>(simulation.view().positions[0].y);
  EXPECT_NEAR(height / kSpacing, 0.5 - 0.25 / 40, 2e-3);
  EXPECT_LT(simulation.view().velocities[0].xyz().norm(), 2e-3F);
}

TEST(Penalty, LosesNoParticleAndIsTheSameForAnyNumberOfThreads) {
  for (const SolverMethod method : {SolverMethod::pbf, SolverMethod::dfsph}) {
    Scene scene = handled(smallDamBreak(), "penalty");
    scene.solver.takeMethod(method);
    const auto hashAfter = [&](int threads) {
      Simulation simulation(scene, threads);
      const std::size_t count = simulation.view().positions.size();
      for (int k = 0; k < 120; ++k) simulation.advanceFrame();
      EXPECT_FALSE(simulation.statistics().failed());
      EXPECT_EQ(simulation.view().positions.size(), count);
      EXPECT_LT(simulation.statistics().maxPenetration, 1e-4);
      return simulation.stateHash();
    };
    const std::uint64_t alone = hashAfter(1);
    EXPECT_EQ(hashAfter(3), alone);
  }
}

}  // namespace penalty_test
}  // namespace migiwa
