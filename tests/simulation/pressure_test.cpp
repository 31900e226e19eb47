// The pressure that the multipliers of a step stand for, against hydrostatics.
#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "core/study/study.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace pressure_test {

using namespace migiwa::testing;

constexpr double kPerMetre = 1000 * 9.81;  // rho0 g (Pa/m)

/// Water at rest, solved well, over two hundred frames.
Scene restingWater() {
  Scene scene = stillTank({8, 16, 8});
  scene.solver.tolerance = 0.0005;
  scene.solver.maxIterations = 60;
  return scene;
}

PressureProfile profileOf(Simulation& simulation, int settling, int sampled) {
  simulation.watchPressure(true);
  PressureProfile profile;
  for (int frame = 0; frame < settling + sampled; ++frame) {
    simulation.advanceFrame();
    if (frame >= settling) profile.sample(simulation);
  }
  return profile;
}

TEST(Pressure, OfWaterAtRestIsThatOfItsDepth) {
  Simulation simulation(restingWater(), 1);
  const PressureProfile profile = profileOf(simulation, 300, 100);
  EXPECT_LT(*profile.error(), 0.06);
  // The slope of the line through the origin that fits the particles best.
  double products = 0, squares = 0;
  for (const PressureLayer& layer : profile.layers()) {
    products += layer.particles * layer.pressure * layer.depth;
    squares += layer.particles * layer.depth * layer.depth;
  }
  EXPECT_NEAR(products / squares / kPerMetre, 1, 0.08);
}

TEST(Pressure, DoesNotDependOnHowIterationsAreStretched) {
  Scene plain = restingWater();
  plain.solver.acceleration = Acceleration::none;
  plain.solver.maxIterations = 200;
  Simulation stretched(restingWater(), 1), one(plain, 1);
  const std::vector<PressureLayer> with = profileOf(stretched, 300, 100).layers();
  const std::vector<PressureLayer> without = profileOf(one, 300, 100).layers();
  for (std::size_t k = 0; k < std::min(with.size(), without.size()); ++k)
    EXPECT_NEAR(with[k].pressure, without[k].pressure, 0.05 * kPerMetre * 16 * kSpacing) << with[k].depth;
}

TEST(Pressure, WatchingItChangesNothing) {
  Simulation watched(smallDamBreak(), 1), alone(smallDamBreak(), 2);
  watched.watchPressure(true);
  for (int frame = 0; frame < 40; ++frame) {
    watched.advanceFrame(), alone.advanceFrame();
    if (frame == 20) watched.watchPressure(false);
  }
  EXPECT_EQ(watched.stateHash(), alone.stateHash());
  EXPECT_TRUE(watched.view().pressure.empty());
}

TEST(Pressure, ASceneColouredByItHasItFromTheStart) {
  Scene scene = smallDamBreak();
  scene.view.color = ColorField::pressure;
  Simulation simulation(scene, 1);
  simulation.advanceFrame();
  std::vector<float> values;
  colorFieldValues(simulation.view(), ColorField::pressure, values);
  const std::span<const float> pressure = simulation.view().pressure;
  ASSERT_EQ(values.size(), pressure.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_FLOAT_EQ(1000 * values[i], pressure[i]);
  // Watched or not, there is a value for each particle.
  simulation.watchPressure(false);
  simulation.advanceFrame();
  colorFieldValues(simulation.view(), ColorField::pressure, values);
  EXPECT_EQ(values, std::vector<float>(pressure.size(), 0));
}

TEST(Pressure, IsNoneInFreeFall) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.3, 0.3, 0.3});
  Simulation simulation(scene, 1);
  simulation.watchPressure(true);
  for (int frame = 0; frame < 20; ++frame) simulation.advanceFrame();
  const std::span<const float> pressure = simulation.view().pressure;
  ASSERT_EQ(pressure.size(), 216U);
  // What a tenth of a percent of density is to the solver: nothing compared with a block's depth of water.
  for (const float value : pressure) EXPECT_LT(static_cast<double>(value), 0.02 * kPerMetre * 0.3);
}

}  // namespace pressure_test
}  // namespace migiwa
