// Friction at walls against Coulomb's law: how far a layer of water slides, and on which slope it stays.
#include <numbers>

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "core/walls/shapes.h"
#include "tests/support/moments.h"
#include "tests/support/test_effects.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace wall_friction_test {

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

/// A bar in the corner of two walls, between which gravity points: `degrees` is the angle that they enclose.
Scene barInGroove(double degrees, double velocity, const std::string& effects) {
  Scene scene = emptyScene();
  const double half = 0.5 * degrees * std::numbers::pi / 180;
  scene.gravity = {0, -kGravity, 0};
  // Each wall is half a spacing away from a row of particles along z.
  const double height = 0.5 * kSpacing / std::sin(half);
  addFluid(scene, {-0.5 * kSpacing, height - 0.5 * kSpacing, 0},
           {0.5 * kSpacing, height + 0.5 * kSpacing, 8 * kSpacing}, {0, 0, velocity});
  for (const double side : {-1.0, 1.0})
    scene.surfaces.push_back(
        std::make_shared<Plane>(Vec3d::Zero(), Vec3d(side * std::cos(half), std::sin(half), 0)));
  scene.effects = effectsOf(effects);
  return scene;
}

double meanVelocityAlongGroove(const Simulation& simulation) {
  return momentsOf(simulation.view()).momentum.z() / static_cast<double>(simulation.view().positions.size());
}

TEST(WallFriction, InAGrooveBothWallsBrake) {
  // Each wall bears N with 2 N sin(half) = weight: friction is mu / sin(half) of the weight.
  for (const double degrees : {90.0, 60.0, 120.0}) {
    constexpr double kFriction = 0.2, kTime = 0.2;
    Simulation simulation(barInGroove(degrees, 1, R"({"wall_friction": {"coefficient": 0.2}})"), 1);
    runFor(simulation, kTime);
    const double deceleration = kFriction * kGravity / std::sin(0.5 * degrees * std::numbers::pi / 180);
    EXPECT_NEAR(1 - meanVelocityAlongGroove(simulation), deceleration * kTime, 0.03 * deceleration * kTime)
        << "between walls at " << degrees << " degrees";
  }
}

TEST(WallFriction, OfTwoWallsEachDragsByItsOwnMove) {
  // One wall moves along the groove, the other stands: pushes are equal, so are their frictions, and
  // a bar at any speed in between is neither sped up nor braked.
  constexpr double kWall = 0.8;
  Scene scene = barInGroove(90, 0.3, R"({"wall_friction": {"coefficient": 0.25}})");
  auto wall = std::make_shared<Plane>(Vec3d::Zero(), Vec3d(-1, 1, 0));
  Motion motion;
  motion.velocity = {0, 0, kWall};
  wall->motion = motion;
  scene.surfaces[0] = wall;
  for (const bool swapped : {false, true}) {
    if (swapped) std::swap(scene.surfaces[0], scene.surfaces[1]);
    Simulation simulation(scene, 1);
    runFor(simulation, 0.3);
    EXPECT_NEAR(meanVelocityAlongGroove(simulation), 0.3, 1e-3);
  }
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

}  // namespace wall_friction_test
}  // namespace migiwa
