// Friction at walls against Coulomb's law: how far a layer of water slides, and on which slope it stays.
#include <numbers>

#include <gtest/gtest.h>

#include "core/boundary/plane.h"
#include "core/simulation/simulation.h"
#include "tests/support/moments.h"
#include "tests/support/test_effects.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace {

using namespace migiwa::testing;

constexpr double kGravity = 9.81;

/// A layer on a floor that is tilted about z: gravity is, instead.
Scene layer(int height, double velocity, double degrees, const std::string& effects) {
  Scene scene = emptyScene();
  const double angle = degrees * std::numbers::pi / 180;
  scene.gravity = kGravity * Vec3d(std::sin(angle), -std::cos(angle), 0);
  addFluid(scene, Vec3d::Zero(), {8 * kSpacing, height * kSpacing, 8 * kSpacing}, {velocity, 0, 0});
  scene.surfaces.push_back(std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY()));
  scene.effects = effectsOf(effects);
  return scene;
}

double meanVelocity(const Simulation& simulation) {
  const Moments moments = momentsOf(simulation.view());
  return moments.momentum.x() / static_cast<double>(simulation.view().positions.size());
}

void runFor(Simulation& simulation, double seconds) {
  const long last = simulation.frameAt(seconds);
  while (simulation.frame() < last && !simulation.stopped()) simulation.advanceFrame();
}

TEST(WallFriction, ALayerStopsAfterItsStoppingDistance) {
  constexpr double kFriction = 0.25, kVelocity = 1;
  Simulation simulation(layer(1, kVelocity, 0, R"({"wall_friction": {"coefficient": 0.25}})"), 1);
  const double start = momentsOf(simulation.view()).centre.x();
  runFor(simulation, 0.2);
  EXPECT_NEAR(meanVelocity(simulation), kVelocity - kFriction * kGravity * 0.2, 0.02 * kVelocity);
  runFor(simulation, 0.6);
  EXPECT_NEAR(meanVelocity(simulation), 0, 1e-3);
  const double distance = momentsOf(simulation.view()).centre.x() - start;
  EXPECT_NEAR(distance, kVelocity * kVelocity / (2 * kFriction * kGravity), 0.03 * 0.2);
}

TEST(WallFriction, ADeepLayerIsBrakedByItsWholeWeight) {
  // Stirred so stiffly that the layers above do not slide over those below.
  Simulation simulation(layer(4, 1, 0, R"({"wall_friction": {"coefficient": 0.25},
                                           "viscosity": {"xsph": 0, "kinematic": 1}})"),
                        1);
  runFor(simulation, 0.05);
  const double first = meanVelocity(simulation);
  runFor(simulation, 0.25);
  EXPECT_NEAR((first - meanVelocity(simulation)) / 0.2, 0.25 * kGravity, 0.05 * 0.25 * kGravity);
}

TEST(WallFriction, ALayerStaysOnASlopeUpToItsAngleAndSlidesBeyond) {
  const std::string effects = R"({"wall_friction": {"coefficient": 0.3}})";
  Simulation below(layer(1, 0, 15, effects), 1);  // tan 15 = 0.268
  runFor(below, 0.5);
  EXPECT_NEAR(meanVelocity(below), 0, 1e-3);
  Simulation beyond(layer(1, 0, 20, effects), 1);  // tan 20 = 0.364
  runFor(beyond, 0.5);
  const double angle = 20 * std::numbers::pi / 180;
  const double acceleration = kGravity * (std::sin(angle) - 0.3 * std::cos(angle));
  EXPECT_NEAR(meanVelocity(beyond), 0.5 * acceleration, 0.03 * 0.5 * acceleration);
}

TEST(WallFriction, AMovingWallDragsALayerAlong) {
  constexpr double kWall = 0.8, kFriction = 0.25;
  Scene scene = layer(1, 0, 0, R"({"wall_friction": {"coefficient": 0.25}})");
  auto floor = std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY());
  Motion motion;
  motion.velocity = {kWall, 0, 0};
  floor->motion = motion;
  scene.surfaces = {floor};
  Simulation simulation(scene, 1);
  runFor(simulation, 0.2);
  EXPECT_NEAR(meanVelocity(simulation), kFriction * kGravity * 0.2, 0.03 * kWall);
  runFor(simulation, 0.6);  // kWall / (kFriction * kGravity) = 0.33 s
  EXPECT_NEAR(meanVelocity(simulation), kWall, 0.01 * kWall);
}

TEST(WallFriction, WithoutItALayerSlidesForEver) {
  Simulation simulation(layer(1, 1, 0, "{}"), 1);
  runFor(simulation, 0.5);
  EXPECT_NEAR(meanVelocity(simulation), 1, 1e-4);
}

}  // namespace
}  // namespace migiwa
