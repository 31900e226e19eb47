// What leaves a scene and what drains take, against closed forms and conservation.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "core/scene/drain.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "core/simulation/state.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace outflow_test {

using namespace migiwa::testing;

constexpr double kVolume = kSpacing * kSpacing * kSpacing;

Scene withinBounds(Scene scene, const Vec3d& min, const Vec3d& max) {
  scene.domain = {true, min, max};
  return scene;
}

Drain boxDrain(const Vec3d& min, const Vec3d& max) {
  Drain drain;
  drain.min = min, drain.max = max;
  return drain;
}

Emitter tap(const Vec3d& center, double radius, double speed) {
  Emitter emitter;
  emitter.center = center, emitter.radius = radius, emitter.speed = speed;
  emitter.particles = 1000000;
  return emitter;
}

void advance(Simulation& simulation, double until) {
  while (simulation.frame() < simulation.frameAt(until) && !simulation.stopped()) simulation.advanceFrame();
}

std::int64_t particlesOf(const Simulation& simulation) {
  return static_cast<std::int64_t>(simulation.view().positions.size());
}

void expectBalanced(const Simulation& simulation) {
  const FluidBalance& fluid = simulation.statistics().fluid;
  EXPECT_EQ(fluid.started + fluid.emitted, particlesOf(simulation) + fluid.left + fluid.drained());
}

/// A tank that a tap fills and that runs over at 0.35 m into a drain.
Scene weir() {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.6, 0.3, 0.4});
  addTank(scene, Vec3d::Zero(), {0.6, 0.8, 0.4});
  scene.emitters = {tap({0.2, 0.6, 0.2}, 0.1, 1)};
  scene.drains = {boxDrain({0.5, 0.35, 0}, {0.6, 0.8, 0.4})};
  return scene;
}

/// Water that runs off a block on all sides.
Scene table() {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, {-0.3, 0.05, -0.3}, {0.3, 0.6, 0.3});
  scene.surfaces.push_back(
      std::make_shared<Box>(Vec3d(-0.6, -0.2, -0.6), Vec3d(0.6, 0, 0.6), Box::Fluid::outside));
  return scene;
}

TEST(Outflow, FluidThatFliesFreeLeavesWhereTheBoundsEnd) {
  Scene scene = withinBounds(emptyScene(), {-1, -1, -1}, {0.5, 1, 1});
  addFluid(scene, Vec3d::Zero(), {0.4, 0.2, 0.2}, {2, 0, 0});
  Simulation simulation(scene, 2);
  const std::int64_t start = particlesOf(simulation);
  for (int k = 1; k <= 100; ++k) {
    simulation.advanceFrame();
    // What is out after a step leaves before the next one. A lattice at rest keeps its form to a millimetre.
    const double flown = 2 * (simulation.time() - scene.solver.timeStep);
    std::int64_t most = 0, least = 0;
    for (int column = 0; column < 8; ++column) {
      const double x = (column + 0.5) * kSpacing + flown;
      if (x > 0.5 - 0.002) most += start / 8;
      if (x > 0.5 + 0.002) least += start / 8;
    }
    ASSERT_GE(simulation.statistics().fluid.left, least) << k;
    ASSERT_LE(simulation.statistics().fluid.left, most) << k;
  }
  EXPECT_EQ(simulation.statistics().fluid.left, start);
  EXPECT_EQ(particlesOf(simulation), 0);
  EXPECT_FALSE(simulation.stopped());
  EXPECT_TRUE(simulation.statistics().trouble.empty());
}

TEST(Outflow, WaterThatRunsOffATableLeavesAndTheRunGoesOn) {
  Simulation simulation(table(), 2);
  const std::int64_t start = particlesOf(simulation);
  advance(simulation, 6);
  EXPECT_FALSE(simulation.stopped());
  EXPECT_NEAR(simulation.time(), 6, 1e-9);
  EXPECT_GT(simulation.statistics().fluid.left, start / 2);
  expectBalanced(simulation);
  for (const Trouble& trouble : simulation.statistics().trouble)
    EXPECT_EQ(trouble.kind, "not_converged") << trouble.detail;
}

TEST(Outflow, EnergyGoesWithTheFluid) {
  // Thrown up and sideways: kinetic and potential energy of each particle stay until it leaves.
  Scene scene = withinBounds(emptyScene(), {-1, -2, -1}, {0.6, 2, 1});
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.4, 0.2, 0.2}, {1, 2, 0});
  Simulation simulation(scene, 1);
  const EnergyBalance& energy = simulation.statistics().energy;
  const double count = static_cast<double>(particlesOf(simulation));
  std::set<double> levels;
  for (int k = 0; k < 160; ++k) {
    simulation.advanceFrame();
    // Symplectic steps: energies belong to the middle of a step, off by g dt/2 times the speed.
    const double off = count * 0.5 * 9.81 * scene.solver.timeStep * simulation.statistics().maxSpeed;
    ASSERT_NEAR(energy.kinetic + energy.potential, energy.start + energy.outflow, 2 * off) << k;
    ASSERT_NEAR(energy.solver, 0, 1e-3 * count) << k;
    levels.insert(energy.outflow);
  }
  EXPECT_EQ(particlesOf(simulation), 0);
  EXPECT_GT(levels.size(), 4U) << "not all at once";
  EXPECT_EQ(energy.gone, simulation.statistics().fluid.left);
  for (const EnergySample& sample : energy.history) EXPECT_TRUE(std::isfinite(sample.source));
}

TEST(Outflow, ABlowUpIsNotDisguisedAsLeft) {
  Simulation simulation(blowUp(), 1, Guards::off);
  for (int k = 0; k < 200 && !simulation.stopped(); ++k) simulation.advanceFrame();
  const RunStatistics& run = simulation.statistics();
  EXPECT_GT(run.maxSpeed, 100);
  EXPECT_TRUE(run.failed());
  EXPECT_TRUE(std::any_of(run.trouble.begin(), run.trouble.end(),
                          [](const Trouble& trouble) { return trouble.kind == "lost_particle"; }));
}

TEST(Outflow, BoundsAndDrainsAreWrittenAsTheyAreReadAndFluidBeyondThemIsWarnedOf) {
  const Scene scene = parseScene(R"({ "format": 1, "particle_spacing": 0.05,
    "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.5, 0.5, 0.5] },
               { "shape": "box", "min": [2, 0, 0], "max": [3, 1, 1] } ],
    "emitters": [ { "shape": "disc", "center": [0, 4, 0], "radius": 0.1, "direction": [0, -1, 0], "speed": 1 } ],
    "drains": [ { "shape": "box", "min": [0, 0, 0], "max": [0.1, 0.2, 0.3], "rotation": { "axis": [0, 1, 0], "degrees": 30 } },
                { "shape": "sphere", "center": [1, 0, 0], "radius": 0.2, "start": 1, "stop": 2 } ],
    "bounds": { "min": [-1, -1, -1], "max": [1, 1, 1] } })",
                                 "a.json", {{"/drains/1/center", "[2, 0, 0]"}});
  ASSERT_EQ(scene.warnings.size(), 3U);
  EXPECT_NE(scene.warnings[2].find("drains/1 lies outside"), std::string::npos) << scene.warnings[2];
  EXPECT_NE(scene.warnings[0].find("fluid/1 lies outside"), std::string::npos) << scene.warnings[0];
  EXPECT_NE(scene.warnings[1].find("emitters/0 lies outside"), std::string::npos) << scene.warnings[1];
  EXPECT_EQ(scene.domainBounds().max, Vec3d(1, 1, 1));
  ASSERT_EQ(scene.drains.size(), 2U);
  EXPECT_EQ(scene.drains[1].stop, 2);
  const std::string text = writeScene(scene);
  EXPECT_EQ(writeScene(parseScene(text, "a.json")), text);
}

TEST(Outflow, WithoutBoundsTheyAreTenDiagonalsBeyondTheScene) {
  const Scene walled = table();
  // Fluid and block together are 1.2 m wide and deep and 0.8 m high.
  const double away = 10 * std::sqrt(1.2 * 1.2 * 2 + 0.8 * 0.8);
  EXPECT_NEAR(walled.domainBounds().min.x(), -0.6 - away, 1e-9);
  EXPECT_NEAR(walled.domainBounds().max.y(), 0.6 + away, 1e-9);
  Scene open = walled;
  open.surfaces.clear();
  EXPECT_TRUE(open.domainBounds().empty());
}

TEST(Outflow, WhatStartsFastMayLeaveFast) {
  Scene scene = withinBounds(emptyScene(), {-1, -1, -1}, {1, 1, 1});
  addFluid(scene, Vec3d::Zero(), {0.2, 0.2, 0.2}, {500, 0, 0});
  Simulation simulation(scene, 1);
  for (int k = 0; k < 10; ++k) simulation.advanceFrame();
  EXPECT_FALSE(simulation.stopped());
  EXPECT_EQ(simulation.statistics().fluid.left, simulation.statistics().fluid.started);
}

TEST(Drains, TakeTheVolumeOfAJetOverTime) {
  Scene scene = emptyScene();
  scene.emitters = {tap({0, 0, 0}, 0.1, 2)};
  scene.emitters[0].direction = {1, 0, 0};
  scene.drains = {boxDrain({0.5, -0.5, -0.5}, {1, 0.5, 0.5}), boxDrain({0.6, -1, -1}, {3, 1, 1})};
  Simulation simulation(scene, 2);
  advance(simulation, 2);
  const FluidBalance& fluid = simulation.statistics().fluid;
  ASSERT_EQ(fluid.drains.size(), 2U);
  EXPECT_EQ(fluid.drains[1].particles, 0) << "behind the first, and within it the first counts";
  const double layer = scene.emitters[0].area() * mouthLayer(scene.emitters[0], kSpacing).thickness;
  const double rate = scene.emitters[0].area() * 2;
  ASSERT_GT(fluid.drains[0].history.size(), 100U);
  for (const DrainSample& sample : fluid.drains[0].history) {
    // The front has 0.5 m to go; layers come whole, and a step later than they arrive.
    const double expected = std::max(0.0, rate * (sample.time - 0.25));
    ASSERT_NEAR(static_cast<double>(sample.particles) * kVolume, expected, 2 * layer) << sample.time;
  }
  expectBalanced(simulation);
}

TEST(Drains, OpenAndCloseWhenTheyAreTold) {
  Scene scene = emptyScene();
  addFluid(scene, Vec3d::Zero(), {0.4, 0.2, 0.2});
  Drain drain = boxDrain({0, 0, 0}, {0.2, 0.2, 0.2});
  drain.start = 0.1, drain.stop = 0.2;
  scene.drains = {drain};
  Simulation simulation(scene, 1);
  const std::int64_t start = particlesOf(simulation);
  advance(simulation, 0.1);
  EXPECT_EQ(particlesOf(simulation), start);
  advance(simulation, 0.11);
  EXPECT_EQ(particlesOf(simulation), start / 2);
  Drain late = drain;
  late.start = 0.3, late.stop = 0.4;
  EXPECT_FALSE(late.openAt(0.4));
  EXPECT_TRUE(late.openAt(0.3));
}

TEST(Drains, ATurnedBoxAndABallHoldTheirVolume) {
  Drain box = boxDrain({0.1, 0.2, 0.3}, {0.5, 0.8, 0.6});
  box.rotation = {{1, 2, 3}, 40};
  Drain ball;
  ball.shape = DrainShape::sphere;
  ball.center = {0.3, 0.5, 0.45}, ball.radius = 0.3;
  const DrainRegion inBox(box), inBall(ball);
  constexpr int kCells = 80;
  int boxed = 0, balled = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j)
      for (int k = 0; k < kCells; ++k) {
        const Vec3d p = Vec3d(0.3, 0.5, 0.45) +
                        (Vec3d(i, j, k) + Vec3d::Constant(0.5 - 0.5 * kCells)) / static_cast<double>(kCells);
        if (inBox.contains(p)) ++boxed;
        if (inBall.contains(p)) ++balled;
      }
  const double cell = std::pow(kCells, -3);
  EXPECT_NEAR(boxed * cell, 0.4 * 0.6 * 0.3, 0.01 * 0.072);
  EXPECT_NEAR(balled * cell, 4.0 / 3 * std::numbers::pi * 0.027, 0.01 * 0.113);
  // The long axis of the box points along its turned second axis.
  const Vec3d along = box.rotation.matrix().col(1);
  EXPECT_TRUE(inBox.contains(Vec3d(0.3, 0.5, 0.45) + 0.29 * along));
  EXPECT_FALSE(inBox.contains(Vec3d(0.3, 0.5, 0.45) + 0.31 * along));
}

TEST(Drains, HoldASteadyLevelTogetherWithAnEmitter) {
  Simulation simulation(weir(), 2);
  advance(simulation, 4);
  const FluidBalance& fluid = simulation.statistics().fluid;
  const auto emitted = static_cast<double>(fluid.emitted), drained = static_cast<double>(fluid.drained());
  const auto level = static_cast<double>(particlesOf(simulation));
  advance(simulation, 9);
  const double in = static_cast<double>(fluid.emitted) - emitted,
               out = static_cast<double>(fluid.drained()) - drained;
  EXPECT_NEAR(in * kVolume, std::numbers::pi * 0.01 * 1 * 5, 0.02 * in * kVolume);
  EXPECT_NEAR(out, in, 0.02 * in);
  EXPECT_NEAR(static_cast<double>(particlesOf(simulation)), level, 0.05 * level);
  EXPECT_EQ(fluid.left, 0);
  expectBalanced(simulation);
  const EnergyBalance& energy = simulation.statistics().energy;
  const double sum = energy.start + energy.emitters + energy.outflow + energy.solver + energy.effects;
  // Energies of steps belong to their middle, those of fluid that comes and goes to its end: half a step on,
  // a particle of 3 m/s is off by this at most.
  const double off = 0.5 * 9.81 * simulation.scene().solver.timeStep * 3;
  EXPECT_NEAR(energy.kinetic + energy.potential, sum,
              off * static_cast<double>(fluid.made() + fluid.drained()));
  for (const Trouble& trouble : simulation.statistics().trouble)
    EXPECT_EQ(trouble.kind, "not_converged") << trouble.detail;
}

TEST(Drains, IdsStayUniqueAndNoneComesTwice) {
  Simulation simulation(weir(), 1);
  std::set<std::uint32_t> gone, before;
  for (int k = 0; k < 400; ++k) {
    simulation.advanceFrame();
    const FrameView view = simulation.view();
    const std::set<std::uint32_t> now(view.ids.begin(), view.ids.end());
    ASSERT_EQ(now.size(), view.ids.size());
    std::set_difference(before.begin(), before.end(), now.begin(), now.end(),
                        std::inserter(gone, gone.end()));
    ASSERT_TRUE(std::none_of(now.begin(), now.end(), [&](std::uint32_t id) { return gone.contains(id); }));
    before = now;
  }
  EXPECT_GT(gone.size(), 100U);
  EXPECT_EQ(static_cast<std::int64_t>(gone.size()), simulation.statistics().fluid.drained());
}

TEST(Drains, ThatNoFluidCanComeIntoAreNamedWithBothPlacesAndTheRemedy) {
  const auto warnings = [](const Drain& drain) {
    Scene scene = emptyScene();
    addTank(scene, Vec3d::Zero(), Vec3d::Ones());
    scene.surfaces.push_back(
        std::make_shared<Box>(Vec3d(0.4, 0, 0.4), Vec3d(0.6, 0.5, 0.6), Box::Fluid::outside));
    scene.drains = {drain};
    return Simulation(scene, 1).scene().warnings;
  };
  // Half a spacing is as near to a wall as particles come.
  constexpr double kBarely = 0.52 * kSpacing, kTooLittle = 0.45 * kSpacing;
  EXPECT_TRUE(warnings(boxDrain({0.2, -0.3, 0.2}, {0.3, kBarely, 0.3})).empty());
  EXPECT_TRUE(warnings(boxDrain({-1, -1, -1}, {2, 2, 2})).empty());
  EXPECT_TRUE(warnings(boxDrain({0.3, 0.1, 0.3}, {0.7, 0.2, 0.7})).empty()) << "around the block";
  EXPECT_EQ(warnings(boxDrain({0.2, -0.3, 0.2}, {0.3, kTooLittle, 0.3})).size(), 1U);
  EXPECT_EQ(warnings(boxDrain({0.41, 0.1, 0.41}, {0.59, 0.4, 0.59})).size(), 1U) << "in the block";
  Drain ball;
  ball.shape = DrainShape::sphere;
  ball.radius = 0.2;
  // Its bounds reach into the tank's corner, the ball itself does not.
  ball.center = {1.15, 1.15, 0.5};
  EXPECT_EQ(warnings(ball).size(), 1U);
  ball.center = {1.1, 1.1, 0.5};
  EXPECT_TRUE(warnings(ball).empty());
  const auto outside = warnings(boxDrain({2, 0, 0}, {2.5, 0.2, 0.25}));
  ASSERT_EQ(outside.size(), 1U);
  EXPECT_EQ(
      outside[0],
      "/drains/0: it never takes anything, for all of it lies within the walls, outside of the vessel, "
      "or nearer to a wall than half a particle_spacing: from (2, 0, 0) to (2.5, 0.2, 0.25) m; fluid and "
      "walls reach from (0, 0, 0) to (1, 1, 1) m. Move it to where fluid comes by");
}

TEST(Drains, FarFromAllElseAreNamed) {
  Scene scene = table();
  scene.drains = {boxDrain({0, -1.4, 0}, {0.5, -1, 0.5}), boxDrain({0, -9, 0}, {0.5, -8, 0.5})};
  const auto warnings = Simulation(scene, 1).scene().warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].starts_with("/drains/1: it is far from fluid and walls: from (0, -9, 0) to "))
      << warnings[0];
}

TEST(Drains, TheHashDoesNotDependOnThreadsNorOnASave) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    Simulation simulation(weir(), threads);
    advance(simulation, 1.5);
    hashes.push_back(simulation.stateHash());
    EXPECT_GT(simulation.statistics().fluid.drained(), 100);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);

  Simulation first(weir(), 1);
  advance(first, 1);
  const StateImage image = StateImage::of(first);
  Simulation second(weir(), 2);
  image.restore(second);
  EXPECT_EQ(second.statistics().fluid.drained(), first.statistics().fluid.drained());
  for (Simulation* simulation : {&first, &second}) {
    advance(*simulation, 1.5);
    EXPECT_EQ(simulation->stateHash(), hashes[0]);
    expectBalanced(*simulation);
  }
  const DrainTally &one = first.statistics().fluid.drains[0], &other = second.statistics().fluid.drains[0];
  ASSERT_EQ(one.history.size(), other.history.size());
  EXPECT_EQ(one.history.back().particles, other.history.back().particles);
}

TEST(Drains, AllThatAFrameShowsHasOneLength) {
  Simulation simulation(weir(), 1);
  simulation.watchPressure(true);
  for (int k = 0; k < 200; ++k) {
    simulation.advanceFrame();
    const FrameView view = simulation.view();
    const std::size_t n = view.ids.size();
    for (const std::size_t size : {view.positions.size(), view.velocities.size(), view.density.size(),
                                   view.gamma.size(), view.lambda.size(), view.neighbours.size(),
                                   view.pressure.size(), simulation.gammaGradients().size()})
      ASSERT_EQ(size, n) << k;
  }
}

}  // namespace outflow_test
}  // namespace migiwa
