// The energy balance against mechanics: free flight, a falling stone, a wall that shoves, an emitter.
#include <cmath>

#include <gtest/gtest.h>

#include "core/boundary/boundary.h"
#include "core/scene/scene_reader.h"
#include "core/simulation/simulation.h"
#include "core/solver/step_state.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {
namespace {

void advance(Simulation& simulation, double until) {
  while (simulation.frame() < simulation.frameAt(until)) simulation.advanceFrame();
}

TEST(EnergyBalance, FreeFlightKeepsItsEnergy) {
  Scene scene = emptyScene();
  scene.gravity = {1, -9.81, 2};
  addFluid(scene, Vec3d::Zero(), {0.1, 0.1, 0.1}, {3, 5, -2});
  Simulation simulation(scene, 1);
  advance(simulation, 1);
  const EnergyBalance& energy = simulation.statistics().energy;
  const Vec3d velocity = Vec3d(3, 5, -2) + scene.gravity;
  EXPECT_NEAR(energy.kinetic, 8 * 0.5 * velocity.squaredNorm(), 1e-3 * energy.kinetic);
  // Rounding of positions of up to 8 m to 2^-22 m, over a step of 5 ms, at 15 m/s, 200 times at random.
  EXPECT_LT(std::abs(energy.solver), 8 * 0x1p-22 / 0.005 * 15 * std::sqrt(200.0));
}

TEST(EnergyBalance, WhatFallsOntoTheFloorLosesAllItsEnergy) {
  Scene scene = emptyScene();
  scene.gravity = {0, -10, 0};
  addFluid(scene, {0, 1, 0}, {kSpacing, 1 + kSpacing, kSpacing});
  addTank(scene, {-1, 0, -1}, {1, 2, 1});
  Simulation simulation(scene, 1);
  advance(simulation, 1);
  const EnergyBalance& energy = simulation.statistics().energy;
  EXPECT_NEAR(energy.kinetic, 0, 1e-9);
  EXPECT_NEAR(energy.start - energy.potential, 10 * 1.0, 1e-3) << "a fall of 1 m";
  EXPECT_NEAR(energy.solver, -10 * 1.0, 2e-3);
  EXPECT_EQ(energy.walls, 0);
  EXPECT_LE(energy.mostGained, 1e-3);
}

/// A plate that pushes a block of water through free space at 1 m/s.
Scene shovedBlock() {
  Scene scene = parseScene(R"({ "format": 1, "particle_spacing": 0.05, "gravity": [0, 0, 0],
      "fluid": [{ "shape": "box", "min": [0, 0, 0], "max": [0.3, 0.3, 0.3] }],
      "boundary": { "surfaces": [{ "shape": "box", "fluid": "outside", "min": [-0.4, -1, -1],
          "max": [-0.1, 1.3, 1.3], "motion": { "velocity": [1, 0, 0] } }] } })",
                           "shoved.json");
  return scene;
}

TEST(EnergyBalance, AWallThatShovesDoesTheWorkOfItsImpulse) {
  Simulation simulation(shovedBlock(), 1);
  advance(simulation, 1);
  double impulse = 0;
  for (const Float4& v : simulation.view().velocities) impulse += static_cast<double>(v.x);
  const EnergyBalance& energy = simulation.statistics().energy;
  ASSERT_GT(impulse, 0.9 * static_cast<double>(simulation.view().positions.size())) << "it must move along";
  // The only force is the wall's, and the wall is at 1 m/s all the time.
  EXPECT_NEAR(energy.walls, impulse * 1.0, 1e-3 * impulse);
  EXPECT_GE(energy.walls, energy.kinetic);
  EXPECT_NEAR(energy.solver, energy.kinetic - energy.walls, 1e-3 * energy.walls);
}

TEST(EnergyBalance, AnEmitterGivesTheKineticEnergyOfItsJet) {
  const Scene scene =
      parseScene(R"({ "format": 1, "particle_spacing": 0.05, "gravity": [0, 0, 0], "fluid": [],
      "emitters": [{ "shape": "disc", "center": [0, 0, 0], "radius": 0.1, "direction": [0, 1, 0], "speed": 2 }] })",
                 "jet.json");
  Simulation simulation(scene, 1);
  advance(simulation, 0.5);
  const EnergyBalance& energy = simulation.statistics().energy;
  const auto particles = static_cast<double>(simulation.view().positions.size());
  ASSERT_GT(particles, 0);
  EXPECT_EQ(energy.start, 0);
  EXPECT_DOUBLE_EQ(energy.emitters, particles * 0.5 * 2 * 2);
  EXPECT_NEAR(energy.kinetic, energy.emitters, 0.01 * energy.emitters);
}

TEST(EnergyBalance, ViscosityTakesNoMoreThanThereIsAndTheSolverAddsNothing) {
  Simulation simulation(smallDamBreak(), 1);
  advance(simulation, 1);
  const EnergyBalance& energy = simulation.statistics().energy;
  EXPECT_LT(energy.effects, 0);
  EXPECT_LT(energy.solver, 0);
  // Nothing else takes part, so the books close: all that is lost is somewhere.
  const double lost = energy.start - energy.kinetic - energy.potential;
  const double half = 0.5 * 0.005 * 9.81 * simulation.statistics().maxSpeed *
                      static_cast<double>(simulation.view().positions.size());
  EXPECT_NEAR(lost, -energy.effects - energy.solver, half) << "within half a step's fall";
}

/// Ten particles with this kinetic energy in all (m^2/s^2).
EnergySums tenWith(double kinetic) {
  EnergySums sums;
  sums.kinetic = kinetic, sums.particles = 10;
  return sums;
}

TEST(EnergyBalance, WhatStepsMayAddIsAddedUpAndWhatIsOwedStaysOwed) {
  ThreadPool pool(1);
  const Boundary none;
  StepState step(pool, none);
  EnergyBalance energy;
  energy.stored = 1;  // 2 for each particle, with the estimate's factor
  const auto excess = [&](double gained, double rounding = 0) {
    return energy.excess(step, tenWith(1000), tenWith(1000 + gained), 0.1, rounding);
  };
  EXPECT_EQ(excess(15), 0);
  EXPECT_EQ(excess(25), 5);
  EXPECT_EQ(excess(25, 0.5), 0);
  EXPECT_EQ(excess(25, 0.4), 5);
  energy.solver = 24;  // 4 more than it may
  EXPECT_EQ(excess(3), 7);
  EXPECT_EQ(excess(-3), 0) << "there is nothing to take back";
  energy.drainedAtRest = 5;
  EXPECT_EQ(excess(3), 2);
  energy.solver = -1e6;
  EXPECT_EQ(excess(100), 30) << "beyond a twentieth of the kinetic energy, however much has been dissipated";
}

TEST(EnergyBalance, WhatEffectsTakeOfMovingFluidMayNotBeAddedAnew) {
  ThreadPool pool(1);
  const Boundary none;
  StepState step(pool, none);
  step.gravity = Vec3f(0, -8, 0);
  step.effectWork = -3;
  EnergyBalance energy;
  // Four steps of 1/8 s make 4 m/s, 8 m^2/s^2 for each particle.
  energy.record(step, tenWith(81), tenWith(78), 0.125, 0);
  EXPECT_EQ(energy.drainedAtRest, 0);
  energy.record(step, tenWith(80), tenWith(77), 0.125, 0);
  EXPECT_EQ(energy.drainedAtRest, 3);
  EXPECT_EQ(energy.effects, -6);
}

TEST(EnergyBalance, TheHistoryStaysShortAndEven) {
  Scene scene = emptyScene();
  addFluid(scene, Vec3d::Zero(), {kSpacing, kSpacing, kSpacing}, {1, 0, 0});
  Simulation simulation(scene, 1);
  advance(simulation, 5);
  const std::vector<EnergySample>& history = simulation.view().info.energy;
  ASSERT_LE(history.size(), EnergyBalance::kMostSamples);
  ASSERT_GE(history.size(), EnergyBalance::kMostSamples / 2);
  EXPECT_EQ(history.front().time, 0);
  for (std::size_t k = 1; k < history.size(); ++k)
    EXPECT_NEAR(history[k].time - history[k - 1].time, history[1].time, 1e-9) << k;
}

}  // namespace
}  // namespace migiwa::testing
