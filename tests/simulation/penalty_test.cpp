// Walls that push by depth ("handling": "penalty"): what the paper's introduction holds against them, and
// what they keep nevertheless.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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

/// One step a frame, so that what a step does can be said from the state before it.
Scene oneStepAFrame(Scene scene, SolverMethod method) {
  scene.solver.takeMethod(method);
  scene.solver.cfl = 0;
  return handled(std::move(scene), "penalty");
}

struct Nearest {
  double distance;
  Vec3d normal;
};

Nearest nearestInTank(const Vec3d& x, const Vec3d& size) {
  Nearest nearest{x.y(), Vec3d::UnitY()};
  for (const int axis : {0, 2}) {
    if (x[axis] < nearest.distance) nearest = {x[axis], Vec3d::Unit(axis)};
    if (size[axis] - x[axis] < nearest.distance) nearest = {size[axis] - x[axis], -Vec3d::Unit(axis)};
  }
  return nearest;
}

/// The force of all springs and dampers in the next step, over a particle's mass (m/s^2), as docs/method.md
/// has it, solved for the end of the step.
template <class Walls>
Vec3d forceOfWalls(const Simulation& simulation, const Scene& scene, const Walls& nearestTo) {
  const double stiffness = 40 * 9.81 / (kSpacing / 4), damping = std::sqrt(stiffness);
  const double dt = scene.solver.timeStep;
  Vec3d sum = Vec3d::Zero();
  const FrameView view = simulation.view();
  for (std::size_t i = 0; i < view.positions.size(); ++i) {
    const Nearest wall = nearestTo(view.positions[i].xyz().cast<double>());
    const double depth = 0.5 * kSpacing - wall.distance;
    if (depth <= 0) continue;
    const double inwards = -(view.velocities[i].xyz().cast<double>() + dt * scene.gravity).dot(wall.normal);
    const double force =
        (stiffness * depth + (damping + dt * stiffness) * inwards) / (1 + dt * damping + dt * dt * stiffness);
    sum += std::max(force, 0.0) * wall.normal;
  }
  return sum;
}

/// Particles that no spring holds any more, but the way in which all walls keep particles out.
template <class Walls>
long sunk(const Simulation& simulation, const Walls& nearestTo) {
  const auto positions = simulation.view().positions;
  return std::count_if(positions.begin(), positions.end(), [&](const Float4& x) {
    return nearestTo(x.xyz().cast<double>()).distance < 0.11 * kSpacing;
  });
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

// Density falls short beside walls that add none, so that particles crowd there; with gamma they do not. They
// do so in the spring, in front of where all walls keep particles out.
TEST(Penalty, CrowdsParticlesAtWallsAsThePaperSays) {
  const Eigen::Vector3i cells(8, 10, 8);
  const auto nearest = [&](const Vec3d& x) { return nearestInTank(x, kSpacing * cells.cast<double>()); };
  const auto after = [&](std::string_view handling) {
    Simulation simulation(handled(stillTank(cells), handling), 2);
    for (int k = 0; k < 200; ++k) simulation.advanceFrame();
    EXPECT_FALSE(simulation.statistics().failed());
    EXPECT_EQ(sunk(simulation, nearest), 0);
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

class PenaltyWalls : public ::testing::TestWithParam<SolverMethod> {};

INSTANTIATE_TEST_SUITE_P(Each, PenaltyWalls, ::testing::Values(SolverMethod::pbf, SolverMethod::dfsph),
                         [](const auto& tested) {
                           return std::string(kSolverMethodNames[static_cast<std::size_t>(tested.param)]);
                         });

TEST_P(PenaltyWalls, CarryTheWeightOfWaterAtRest) {
  const Scene scene = oneStepAFrame(stillTank({8, 10, 8}), GetParam());
  const auto nearest = [](const Vec3d& x) { return nearestInTank(x, kSpacing * Vec3d(8, 10, 8)); };
  Simulation simulation(scene, 2);
  const auto count = static_cast<double>(simulation.view().positions.size());
  constexpr int kFrames = 100;
  for (int k = 0; k < 300; ++k) simulation.advanceFrame();
  Vec3d force = Vec3d::Zero();
  long held = 0;
  for (int k = 0; k < kFrames; ++k) {
    force += forceOfWalls(simulation, scene, nearest) / (kFrames * count * 9.81);
    held = std::max(held, sunk(simulation, nearest));
    simulation.advanceFrame();
  }
  EXPECT_EQ(simulation.statistics().steps, simulation.frame());
  EXPECT_NEAR(force.y(), 1, 0.03);
  EXPECT_LT(std::hypot(force.x(), force.z()), 0.03);
  EXPECT_EQ(held, 0);
}

// A block that is thrown at a floor, with nothing else near: what it loses in a step is what the floor gets.
TEST_P(PenaltyWalls, GetTheMomentumThatTheFluidLoses) {
  Scene scene = emptyScene();
  addFluid(scene, {0, 0.1, 0}, {0.2, 0.3, 0.2}, {0.3, -0.5, 0});
  scene.surfaces.push_back(std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY()));
  scene = oneStepAFrame(scene, GetParam());
  const auto nearest = [](const Vec3d& x) { return Nearest{x.y(), Vec3d::UnitY()}; };
  Simulation simulation(scene, 1);
  const auto count = static_cast<double>(simulation.view().positions.size());
  const auto momentum = [&] {
    Vec3d sum = Vec3d::Zero();
    for (const Float4& v : simulation.view().velocities) sum += v.xyz().cast<double>();
    return Vec3d(sum / count);
  };
  const Vec3d began = momentum();
  double worst = 0;
  for (int k = 0; k < 80; ++k) {
    const Vec3d before = momentum();
    const Vec3d given = scene.solver.timeStep * forceOfWalls(simulation, scene, nearest) / count;
    simulation.advanceFrame();
    ASSERT_EQ(sunk(simulation, nearest), 0);
    worst = std::max(worst, (momentum() - before - given).norm());
  }
  EXPECT_EQ(simulation.statistics().steps, simulation.frame());
  EXPECT_LT(worst, 1e-4);
  EXPECT_GT((momentum() - began).y(), 0.3) << "it must have met the floor";
}

// Far from walls no bit is other than without them.
TEST_P(PenaltyWalls, LeaveABlockInFreeFallAlone) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, {0, 1, 0}, {0.2, 1.2, 0.2}, {0.5, 1, 0});
  const auto after = [&](bool walls) {
    Scene with = scene;
    if (walls) with.surfaces.push_back(std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY()));
    Simulation simulation(oneStepAFrame(with, GetParam()), 1);
    for (int k = 0; k < 40; ++k) simulation.advanceFrame();
    Vec3d mean = Vec3d::Zero();
    for (const Float4& v : simulation.view().velocities) mean += v.xyz().cast<double>();
    mean /= static_cast<double>(simulation.view().velocities.size());
    EXPECT_LT((mean - Vec3d(0.5, 1 - 9.81 * 40 * 0.005, 0)).norm(), 5e-4) << "but for the rounding of places";
    return simulation.stateHash();
  };
  EXPECT_EQ(after(true), after(false));
}

// A dam break stays in its tank, and few of its particles go so deep that the spring does not stop them.
TEST_P(PenaltyWalls, LoseNoParticleAndAreTheSameForAnyNumberOfThreads) {
  Scene scene = handled(smallDamBreak(), "penalty");
  scene.solver.takeMethod(GetParam());
  const auto nearest = [](const Vec3d& x) { return nearestInTank(x, {0.9, 0.8, 0.3}); };
  const auto hashAfter = [&](int threads) {
    Simulation simulation(scene, threads);
    const std::size_t count = simulation.view().positions.size();
    long most = 0;
    for (int k = 0; k < 120; ++k) {
      simulation.advanceFrame();
      most = std::max(most, sunk(simulation, nearest));
    }
    EXPECT_FALSE(simulation.statistics().failed());
    EXPECT_EQ(simulation.view().positions.size(), count);
    EXPECT_LT(simulation.statistics().maxPenetration, 1e-4);
    EXPECT_LT(most, 15);
    return simulation.stateHash();
  };
  const std::uint64_t alone = hashAfter(1);
  EXPECT_EQ(hashAfter(3), alone);
}

}  // namespace penalty_test
}  // namespace migiwa
