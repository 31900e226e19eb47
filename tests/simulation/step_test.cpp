// The step against what mechanics says of it.
#include <cmath>

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "core/walls/boundary.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace step_test {

using namespace migiwa::testing;

Vec3d momentum(const FrameView& view) {
  Vec3d sum = Vec3d::Zero();
  for (const Float4& v : view.velocities) sum += v.xyz().cast<double>();
  return sum;
}

Vec3d angularMomentum(const FrameView& view) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < view.positions.size(); ++i) {
    const Vec3d x = view.positions[i].xyz().cast<double>(), v = view.velocities[i].xyz().cast<double>();
    sum += Vec3d(x.y() * v.z() - x.z() * v.y(), x.z() * v.x() - x.x() * v.z(), x.x() * v.y() - x.y() * v.x());
  }
  return sum;
}

Vec3d meanPosition(const FrameView& view) {
  Vec3d sum = Vec3d::Zero();
  for (const Float4& p : view.positions) sum += p.xyz().cast<double>();
  return sum / static_cast<double>(view.positions.size());
}

double meanSpeed(const FrameView& view) {
  double sum = 0;
  for (const Float4& v : view.velocities) sum += static_cast<double>(v.xyz().norm());
  return sum / static_cast<double>(view.velocities.size());
}

TEST(Step, FreeFallIsThatOfSymplecticEuler) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, {0, 0, 0}, {0.25, 0.25, 0.25}, {0.5, 1, 0});
  addViscosity(scene);
  Simulation simulation(scene, 1);
  const Vec3d start = meanPosition(simulation.view());
  constexpr int kSteps = 60;
  for (int k = 0; k < kSteps; ++k) simulation.advanceFrame();
  const double dt = scene.solver.timeStep;
  // x_n = x_0 + n dt v_0 + dt^2 g n (n + 1) / 2, exactly: the lattice is at rest density and nothing else
  // acts.
  const Vec3d expected =
      start + kSteps * dt * Vec3d(0.5, 1, 0) + dt * dt * scene.gravity * (0.5 * kSteps * (kSteps + 1));
  EXPECT_LT((meanPosition(simulation.view()) - expected).norm(), 2e-5);
  for (const Float4& v : simulation.view().velocities) {
    EXPECT_NEAR(static_cast<double>(v.y), 1 - 9.81 * dt * kSteps, 2e-3);
    EXPECT_NEAR(static_cast<double>(v.x), 0.5, 2e-3);
  }
}

TEST(Step, CollidingBlocksKeepMomentumWithoutGravityAndWalls) {
  for (const PositionStep form : {PositionStep::gradient, PositionStep::pairsAndWall, PositionStep::paper}) {
    Scene scene = emptyScene();
    scene.solver.positionStep = form;
    addFluid(scene, {0, 0, 0}, {0.25, 0.25, 0.25}, {1.5, 0, 0});
    addFluid(scene, {0.3, 0.1, 0.05}, {0.5, 0.3, 0.25}, {-2, 0.3, 0});
    addViscosity(scene);
    Simulation simulation(scene, 2);
    const Vec3d before = momentum(simulation.view()), spinBefore = angularMomentum(simulation.view());
    double largestError = 0;
    for (int k = 0; k < 60; ++k) {
      simulation.advanceFrame();
      for (const IterationError& error : simulation.view().info.errors)
        largestError = std::max(largestError, error.max);
    }
    const FrameView view = simulation.view();
    const double scale = static_cast<double>(view.positions.size()) * meanSpeed(view);
    EXPECT_GT(largestError, 0.05) << "they must have collided";
    EXPECT_LT((momentum(view) - before).norm() / scale, 1e-4);
    EXPECT_LT((angularMomentum(view) - spinBefore).norm() / scale, 1e-3);
  }
}

TEST(Step, ALatticeAtRestStaysWhereItIs) {
  Scene scene = emptyScene();
  addFluid(scene, {0, 0, 0}, {0.4, 0.4, 0.4});
  Simulation simulation(scene, 1);
  const FrameSnapshot start = [&] {
    FrameSnapshot snapshot;
    snapshot.assign(simulation.view());
    return snapshot;
  }();
  for (int k = 0; k < 10; ++k) simulation.advanceFrame();
  EXPECT_LT(meanSpeed(simulation.view()), 1e-3);
  EXPECT_LT((meanPosition(simulation.view()) - meanPosition(start.view())).norm(), 1e-6);
}

TEST(Step, IterationsEndAtTheToleranceOrTheirLargestNumber) {
  Scene scene = smallDamBreak();
  scene.solver.tolerance = 0.01;
  Simulation strict(scene, 1);
  scene.solver.tolerance = 0;
  scene.solver.maxIterations = 7;
  scene.solver.acceleration = Acceleration::none;  // or the error vanishes altogether before that
  Simulation endless(scene, 1);
  for (int k = 0; k < 20; ++k) {
    strict.advanceFrame();
    const FrameInfo& info = strict.view().info;
    ASSERT_EQ(info.errors.size(), static_cast<std::size_t>(info.iterations) + 1);
    ASSERT_GE(info.iterations, scene.solver.minIterations);
    ASSERT_LE(info.errors.back().mean, 0.01);
    if (info.iterations > scene.solver.minIterations) {
      ASSERT_GT(info.errors[info.errors.size() - 2].mean, 0.01) << "an iteration too many";
    }
    endless.advanceFrame();
    ASSERT_EQ(endless.view().info.iterations, 7);
  }
  ASSERT_EQ(endless.statistics().trouble.size(), 1U);
  EXPECT_EQ(endless.statistics().trouble[0].kind, "not_converged");
  EXPECT_FALSE(endless.statistics().failed());
}

TEST(Step, MoreIterationsBringTheErrorDown) {
  Scene scene = stillTank({8, 8, 8});
  scene.solver.tolerance = 0;
  scene.solver.maxIterations = 40;
  Simulation simulation(scene, 1);
  // The first solve: after it the water flies apart a little, and there may be no error to bring down.
  simulation.advanceFrame();
  const std::vector<IterationError> errors = simulation.view().info.errors;
  ASSERT_GT(errors.front().mean, 1e-3);
  EXPECT_LT(errors.back().mean, 0.1 * errors.front().mean);
  for (std::size_t k = 1; k < errors.size(); ++k) EXPECT_LT(errors[k].mean, errors[k - 1].mean * 1.05) << k;
}

TEST(Step, SubstepsFollowTheCflRule) {
  Scene scene = emptyScene();
  addFluid(scene, {0, 0, 0}, {0.05, 0.05, 0.05}, {30, 0, 0});
  Simulation simulation(scene, 1);
  simulation.advanceFrame();
  // 30 m/s * 5 ms = 0.15 m; 0.4 h = 0.04 m: four substeps.
  EXPECT_EQ(simulation.statistics().steps, 4);
  EXPECT_NEAR(simulation.time(), 0.005, 1e-12);

  scene.solver.cfl = 0;
  Simulation fixed(scene, 1);
  fixed.advanceFrame();
  EXPECT_EQ(fixed.statistics().steps, 1);

  scene.solver.substeps = 6;
  Simulation finer(scene, 1);
  finer.advanceFrame();
  EXPECT_EQ(finer.statistics().steps, 6);
}

double maxSpeedOfBlockStartingAt(double depth) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, {0, -depth, 0}, {0.4, 0.4 - depth, 0.4}, Vec3d::Zero(), false);
  addTank(scene, Vec3d::Zero(), {0.4, 1, 0.4});
  addViscosity(scene);
  Simulation simulation(scene, 1);
  EXPECT_EQ(simulation.statistics().trouble.size(), depth > 0 ? 1U : 0U);
  for (const Float4& p : simulation.view().positions) EXPECT_GE(p.y, 0.0249F);
  for (int k = 0; k < 20; ++k) simulation.advanceFrame();
  return simulation.statistics().maxSpeed;
}

TEST(Step, FluidThatStartsInsideAWallIsMovedOutWithoutSpeed) {
  const double usual = maxSpeedOfBlockStartingAt(0);
  // The push of half a spacing within one step alone would be 5 m/s.
  EXPECT_LT(maxSpeedOfBlockStartingAt(0.5 * kSpacing), 1.5 * usual);
  EXPECT_LT(maxSpeedOfBlockStartingAt(kSpacing), 2.5 * usual);
}

TEST(Step, CentresStayHalfASpacingInsideTheWalls) {
  Simulation simulation(smallDamBreak(), 1);
  const Boundary boundary(simulation.scene().surfaces);
  for (int k = 0; k < 100; ++k) {
    simulation.advanceFrame();
    for (const Float4& p : simulation.view().positions)
      ASSERT_GE(boundary.distance(p.xyz()), 0.5F * static_cast<float>(kSpacing) - 1e-6F);
  }
  EXPECT_EQ(simulation.statistics().maxPenetration, 0);
}

TEST(Step, CoincidentParticlesPartAndKeepTheirMomentum) {
  Scene scene = emptyScene();
  for (int k = 0; k < 40; ++k) addFluid(scene, {0, 0, 0}, {0.05, 0.05, 0.05});
  Simulation simulation(scene, 1);
  for (int k = 0; k < 200; ++k) simulation.advanceFrame();
  ASSERT_FALSE(simulation.statistics().failed());
  const FrameView view = simulation.view();
  EXPECT_LT(view.info.errors.back().max, 0.1);
  EXPECT_LT(momentum(view).norm(),
            1e-3 * static_cast<double>(view.positions.size()) * meanSpeed(view) + 1e-6);
  for (std::size_t i = 0; i < view.positions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GT((view.positions[i].xyz() - view.positions[j].xyz()).norm(), 1e-4F * view.info.supportRadius);
}

TEST(Step, NoParticlesIsAValidScene) {
  Scene scene = emptyScene();
  addTank(scene, Vec3d::Zero(), Vec3d::Ones());
  Simulation simulation(scene, 2);
  simulation.advanceFrame();
  EXPECT_FALSE(simulation.stopped());
  EXPECT_EQ(simulation.view().positions.size(), 0U);
}

TEST(Step, SettingsTakeEffectWithTheNextFrame) {
  Simulation simulation(smallDamBreak(), 1);
  simulation.advanceFrame();
  EXPECT_EQ(simulation.view().info.handling, "gamma: product");
  Settings settings = simulation.settings();
  settings.boundary.handling = BoundaryHandling::none;
  settings.solver.minIterations = settings.solver.maxIterations = 5;
  simulation.apply(settings);
  simulation.advanceFrame();
  EXPECT_EQ(simulation.view().info.handling, "no correction");
  EXPECT_EQ(simulation.view().info.iterations, 5);
  for (const float gamma : simulation.view().gamma) EXPECT_EQ(gamma, 1);
}

}  // namespace step_test
}  // namespace migiwa
