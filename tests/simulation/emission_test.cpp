// Emitters: what they give against their rate, and how it lies.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/simulation/fill.h"
#include "core/simulation/simulation.h"
#include "core/walls/boundary.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace emission_test {

using namespace migiwa::testing;

Emitter disc(double radius, const Vec3d& direction, double speed) {
  Emitter emitter;
  emitter.radius = radius;
  emitter.direction = direction;
  emitter.speed = speed;
  return emitter;
}

Emitter rectangle(double width, double height, const Vec3d& direction, double speed) {
  Emitter emitter = disc(0.1, direction, speed);
  emitter.shape = MouthShape::rectangle;
  emitter.size = {width, height};
  return emitter;
}

TEST(Emission, VolumeFollowsTheRateToWithinALayer) {
  const std::vector<Emitter> emitters{disc(0.07, {0, -1, 0}, 1), disc(0.21, {1, 1, 0}, 0.7),
                                      rectangle(0.3, 0.13, {0, 0, 2}, 3),
                                      rectangle(0.07, 0.5, {1, -2, 3}, 20)};
  for (const Emitter& emitter : emitters) {
    Scene scene = emptyScene();
    scene.emitters = {emitter};
    Simulation simulation(scene, 1);
    const double layer = emitter.area() * mouthLayer(emitter, kSpacing).thickness;
    for (int k = 0; k < 60; ++k) {
      simulation.advanceFrame();
      const double volume = static_cast<double>(simulation.view().positions.size()) * std::pow(kSpacing, 3);
      // A layer leaves at once, at a substep's start.
      const double most = emitter.area() * emitter.speed * simulation.time() + layer;
      ASSERT_LE(volume, most * (1 + 1e-9));
      ASSERT_GE(volume, most - layer - emitter.area() * emitter.speed * 0.005 * (1 + 1e-9));
    }
    EXPECT_FALSE(simulation.statistics().failed());
  }
}

TEST(Emission, ARateGivenAsVolumeIsTheRate) {
  Emitter emitter = disc(0.15, {0, -1, 0}, 0);
  emitter.rate = 0.1;
  EXPECT_NEAR(emitter.mouthSpeed(), 0.1 / (std::numbers::pi * 0.15 * 0.15), 1e-12);
  Scene scene = emptyScene();
  scene.emitters = {emitter};
  Simulation simulation(scene, 1);
  for (int k = 0; k < 100; ++k) simulation.advanceFrame();
  EXPECT_NEAR(static_cast<double>(simulation.view().positions.size()) * std::pow(kSpacing, 3), 0.05,
              emitter.area() * 2 * kSpacing);
}

TEST(Emission, AFreeJetKeepsTheDensityAndTheSpeedOfTheMouth) {
  Scene scene = emptyScene();
  scene.emitters = {rectangle(0.4, 0.4, {1, 0, 0}, 2)};
  Simulation simulation(scene, 2);
  for (int k = 0; k < 100; ++k) simulation.advanceFrame();
  const FrameView view = simulation.view();
  // Away from the faces of the jet, within it: from the mouth on as dense as the lattice at rest.
  double sum = 0, speed = 0, least = 1e9, most = 0;
  int count = 0;
  for (std::size_t i = 0; i < view.positions.size(); ++i) {
    const Vec3f p = view.positions[i].xyz();
    if (std::abs(p.y()) > 0.1F || std::abs(p.z()) > 0.1F || p.x() < 0.15F || p.x() > 0.8F) continue;
    const auto density = static_cast<double>(view.density[i]);
    sum += density, speed += static_cast<double>(view.velocities[i].x), ++count;
    least = std::min(least, density), most = std::max(most, density);
  }
  ASSERT_GT(count, 100);
  EXPECT_NEAR(sum / count, 1, 0.02);
  // A layer that is missing, or one too many, would show as a fifth.
  EXPECT_GT(least, 0.9);
  EXPECT_LT(most, 1.1);
  EXPECT_NEAR(speed / count, 2, 0.02);
}

TEST(Emission, StartsAndStopsWhenItIsTold) {
  Scene scene = emptyScene();
  scene.emitters = {disc(0.1, {0, 1, 0}, 2)};
  scene.emitters[0].start = 0.1;
  scene.emitters[0].stop = 0.2;
  Simulation simulation(scene, 1);
  for (int k = 0; k < 20; ++k) simulation.advanceFrame();
  EXPECT_EQ(simulation.view().positions.size(), 0U);
  for (int k = 0; k < 21; ++k) simulation.advanceFrame();
  const std::size_t given = simulation.view().positions.size();
  const double rate = scene.emitters[0].area() * 2 / std::pow(kSpacing, 3);
  EXPECT_NEAR(static_cast<double>(given), 0.1 * rate,
              static_cast<double>(mouthLayer(scene.emitters[0], kSpacing).places.size()));
  for (int k = 0; k < 20; ++k) simulation.advanceFrame();
  EXPECT_EQ(simulation.view().positions.size(), given);
}

TEST(Emission, RunsDryAtItsLimitAndSaysSo) {
  Scene scene = emptyScene();
  scene.emitters = {disc(0.1, {0, 1, 0}, 2)};
  scene.emitters[0].particles = 100;
  Simulation simulation(scene, 1);
  for (int k = 0; k < 100; ++k) simulation.advanceFrame();
  const std::size_t layer = mouthLayer(scene.emitters[0], kSpacing).places.size();
  EXPECT_EQ(simulation.view().positions.size(), 100 / layer * layer);
  const auto& trouble = simulation.statistics().trouble;
  EXPECT_TRUE(std::any_of(trouble.begin(), trouble.end(),
                          [](const Trouble& t) { return t.kind == "emitter_limit"; }));
}

TEST(Emission, StopsBeforeThereAreMoreThanASimulationMayHave) {
  Scene scene = emptyScene();
  scene.emitters = {disc(0.1, {0, 1, 0}, 2), disc(0.1, {0, -1, 0}, 2)};
  ThreadPool pool(1);
  const Boundary none;
  StepState state(pool, none);
  RunStatistics statistics;
  constexpr double kMost = 100;
  Emission emission(scene, none, kMost);
  for (int k = 0; k < 100; ++k) emission.emit(0.01 * k, state, statistics);
  const auto layer = static_cast<double>(mouthLayer(scene.emitters[0], kSpacing).places.size());
  EXPECT_LE(static_cast<double>(state.particles.size()), kMost);
  EXPECT_GT(static_cast<double>(state.particles.size()) + layer, kMost);
  ASSERT_FALSE(statistics.trouble.empty());
  EXPECT_EQ(statistics.trouble[0].kind, "particle_limit");
  EXPECT_NE(statistics.trouble[0].detail.find("more than the 100 "), std::string::npos);
}

TEST(Emission, BoundsOfALopsidedMouthHoldIt) {
  for (const double width : {1e-6, 1e-3, 1.0})
    for (const double height : {1e-6, 1e-3, 1.0}) {
      const Bounds bounds = rectangle(width, height, {0, 0, 1}, 1).bounds();
      ASSERT_FALSE(bounds.empty()) << width << " " << height;
      // Of places within the mouth, which are the farther from its rim the fewer they are.
      EXPECT_LE(bounds.size().norm(), std::hypot(width, height));
      if (std::max(width, height) > 10 * std::min(width, height)) {
        EXPECT_GT(bounds.size().norm(), 0.9 * std::max(width, height));
      }
    }
}

Scene tapIn(const Emitter& emitter) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  scene.emitters = {emitter};
  addTank(scene, Vec3d::Zero(), Vec3d::Ones());
  return scene;
}

Emitter tapAt(const Vec3d& center, const Vec3d& direction) {
  Emitter emitter = rectangle(6 * kSpacing, 6 * kSpacing, direction, 1);
  emitter.center = center;
  emitter.xAxis = {0, 0, 1};
  return emitter;
}

TEST(Emission, WhatOfAMouthLiesInAWallGivesNothingAndAddsNoEnergy) {
  // In the edge of two walls: a quarter of its 36 places is in the tank.
  Simulation simulation(tapIn(tapAt({0, 0.8, 0}, {0, -1, 0})), 1);
  ASSERT_EQ(simulation.scene().warnings.size(), 1U);
  EXPECT_EQ(
      simulation.scene().warnings[0],
      "/emitters/0: 75 % of its particles (27 of 36) lie within or too near the walls and are left out: "
      "it gives so much less");
  for (int k = 0; k < 60; ++k) {
    simulation.advanceFrame();
    const RunStatistics& run = simulation.statistics();
    ASSERT_EQ(run.fluid.emitted % 9, 0);
    // A layer in the time that one takes to pass.
    ASSERT_NEAR(static_cast<double>(run.fluid.emitted / 9), simulation.time() / kSpacing, 1.2);
  }
  EXPECT_TRUE(simulation.statistics().trouble.empty()) << simulation.statistics().trouble.front().detail;
}

TEST(Emission, AMouthInTheFloorGivesAllOfItsRateInFrontOfTheFloor) {
  // Layers that stand in the floor were thrown out of it.
  for (const double depth : {0.0, 0.4 * kSpacing}) {
    Simulation simulation(tapIn(tapAt({0.5, -depth, 0.5}, {0, 1, 0})), 1);
    EXPECT_TRUE(simulation.scene().warnings.empty());
    simulation.advanceFrame();
    const FrameView view = simulation.view();
    ASSERT_EQ(view.positions.size(), 36U);
    const double rise = simulation.time() * 1;
    for (const Float4& p : view.positions)
      EXPECT_NEAR(static_cast<double>(p.y), 0.5 * kSpacing + rise, 0.02 * kSpacing) << depth;
    EXPECT_TRUE(simulation.statistics().trouble.empty()) << simulation.statistics().trouble.front().detail;
  }
}

TEST(Emission, AMouthOutsideOfTheVesselIsNamed) {
  Simulation simulation(tapIn(tapAt({0.5, 0.5, -1}, {0, -1, 0})), 1);
  ASSERT_EQ(simulation.scene().warnings.size(), 1U);
  EXPECT_TRUE(simulation.scene().warnings[0].starts_with("/emitters/0: it gives nothing"))
      << simulation.scene().warnings[0];
  for (int k = 0; k < 5; ++k) simulation.advanceFrame();
  EXPECT_EQ(simulation.statistics().fluid.emitted, 0);
}

TEST(Emission, TheHashDoesNotDependOnThreads) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    Scene scene = stillTank({8, 4, 8});
    scene.emitters = {disc(0.1, {0, -1, 0}, 1.5), rectangle(0.1, 0.1, {1, 0, 0}, 1)};
    scene.emitters[0].center = {0.2, 0.35, 0.2};
    scene.emitters[1].center = {0.05, 0.3, 0.2};
    Simulation simulation(scene, threads);
    for (int k = 0; k < 50; ++k) simulation.advanceFrame();
    hashes.push_back(simulation.stateHash());
    EXPECT_GT(simulation.view().positions.size(), 300U);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace emission_test
}  // namespace migiwa
