// The energy balance against mechanics: free flight, a falling stone, a wall that shoves, an emitter.
#include <cmath>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "core/solver/state.h"
#include "core/walls/boundary.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {
namespace energy_balance_test {

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

// The only force is the wall's, and the wall is at 1 m/s all the time. A projection's gradient does not
// conserve momentum to the last digit: what its errors inside the fluid give is nobody's work.
TEST(EnergyBalance, AWallThatShovesDoesTheWorkOfItsImpulse) {
  for (const auto& [step, share] :
       {std::pair{VelocityStep::positions, 1e-3}, {VelocityStep::projection, 0.03}}) {
    SCOPED_TRACE(share);
    Scene scene = shovedBlock();
    scene.solver.takeVelocities(step);
    Simulation simulation(scene, 1);
    advance(simulation, 1);
    double impulse = 0;
    for (const Float4& v : simulation.view().velocities) impulse += static_cast<double>(v.x);
    const EnergyBalance& energy = simulation.statistics().energy;
    ASSERT_GT(impulse, 0.9 * static_cast<double>(simulation.view().positions.size())) << "it must move along";
    EXPECT_NEAR(energy.walls, impulse * 1.0, share * impulse);
    EXPECT_GE(energy.walls, energy.kinetic);
    EXPECT_NEAR(energy.solver, energy.kinetic - energy.walls, 1e-3 * energy.walls);
  }
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

/// A balance of ten particles whose last step left no density errors, unless `meanSquare` says so.
class TenParticles {
 public:
  explicit TenParticles(double meanSquare = 0) {
    step_.supportRadius = 1;
    step_.lattice.squaredGradients = 1;
    leave(meanSquare);
  }

  void leave(double meanSquare) { step_.errors = {{0, 0, meanSquare}}; }
  void begin(bool first = false) { balance_.beginStep(step_, 10, 1, first); }
  double excess(double kinetic, double gained, double rounding = 0) const {
    return balance_.excess(step_, tenWith(kinetic), tenWith(kinetic + gained), 1, rounding);
  }
  void take(double kinetic, double gained) {
    balance_.record(step_, tenWith(kinetic), tenWith(kinetic + gained), 1, 0);
  }

 private:
  ThreadPool pool_{1};
  Boundary none_{{}};
  StepState step_{pool_, none_};
  EnergyBalance balance_;
};

TEST(EnergyBalance, TheFirstStepsMayAddWhatTheStartHasStored) {
  TenParticles fluid(2);  // 1 for each, 20 in all with the estimate's factor
  fluid.begin(true);
  EXPECT_EQ(fluid.excess(0, 15), 0);
  EXPECT_EQ(fluid.excess(0, 25), 5);
  EXPECT_EQ(fluid.excess(0, 25, 0.5), 0);
  EXPECT_EQ(fluid.excess(0, 25, 0.4), 5);
  EXPECT_EQ(fluid.excess(100, -3), 0) << "there is nothing to take back";
  fluid.take(0, 15);
  fluid.begin();
  EXPECT_EQ(fluid.excess(0, 7), 2) << "what has been given is gone, though the errors are still there";
}

TEST(EnergyBalance, DensityErrorsGiveBackWhatWentIntoThem) {
  TenParticles fluid;
  fluid.begin(true);
  EXPECT_EQ(fluid.excess(1000, 1), 1);
  fluid.take(1000, -500);
  fluid.leave(2);
  for (int step = 0; step < 200; ++step) fluid.begin();
  EXPECT_NEAR(fluid.excess(1000, 25), 5, 1e-6) << "20, however much has been dissipated";
}

TEST(EnergyBalance, WhatWasDissipatedLongBeforeIsNotGivenBack) {
  TenParticles fluid;
  fluid.begin(true);
  fluid.take(1000, -80);
  fluid.begin();
  EXPECT_NEAR(fluid.excess(1000, 60), 10, 1e-9) << "a twentieth of the kinetic energy";
  EXPECT_NEAR(fluid.excess(1e6, 90), 20, 1e-9) << "seven eighths of what the step before took";
  for (int step = 0; step < 50; ++step) fluid.begin();
  EXPECT_NEAR(fluid.excess(1e6, 90), 90, 0.2);
}

TEST(EnergyBalance, TheHistoryStaysShortAndEven) {
  Scene scene = emptyScene();
  addFluid(scene, Vec3d::Zero(), {kSpacing, kSpacing, kSpacing}, {1, 0, 0});
  Simulation simulation(scene, 1);
  advance(simulation, 5);
  const std::vector<EnergySample>& history = simulation.view().info.energy;
  ASSERT_LE(history.size(), Thinning::kMostSamples);
  ASSERT_GE(history.size(), Thinning::kMostSamples / 2);
  EXPECT_EQ(history.front().time, 0);
  for (std::size_t k = 1; k < history.size(); ++k)
    EXPECT_NEAR(history[k].time - history[k - 1].time, history[1].time, 1e-9) << k;
}

}  // namespace energy_balance_test
}  // namespace migiwa::testing
