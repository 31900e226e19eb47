// Water at rest, with the correction and without: the paper's claim in numbers.
#include <gtest/gtest.h>

#include "core/simulation/measures.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace rest_test {

using namespace migiwa::testing;

SettledMeasures settle(BoundaryHandling handling) {
  Scene scene = stillTank({16, 15, 16});
  scene.boundary.handling = handling;
  Simulation simulation(scene);
  const SettledMeasures settled = runUntil(simulation, 2.5);
  EXPECT_FALSE(simulation.statistics().failed());
  return settled;
}

TEST(Rest, WithTheCorrectionWaterFillsItsTankEvenly) {
  const SettledMeasures settled = settle(BoundaryHandling::gamma);
  EXPECT_NEAR(*settled.height / *settled.expectedHeight, 1, 0.015);
  EXPECT_GE(*settled.edgeCrowding, 0.95);
  EXPECT_LE(*settled.edgeCrowding, 1.10);
  EXPECT_GE(*settled.nearWallSpacingP1, 0.8 * *settled.bulkSpacingP1);
  EXPECT_LT(*settled.rmsSpeed, 0.03);
}

TEST(Rest, WithoutItParticlesClumpAtTheWallsAndTheWaterSinks) {
  const SettledMeasures settled = settle(BoundaryHandling::none);
  EXPECT_LT(*settled.height / *settled.expectedHeight, 0.92);
  EXPECT_GE(*settled.edgeCrowding, 1.8);
  EXPECT_LT(*settled.nearWallSpacingP1, 0.1 * *settled.bulkSpacingP1);
}

TEST(Rest, ThePressureOfAColumnGrowsLinearlyWithDepth) {
  // [FM] Eq. 11 at rest: the multipliers, summed over a step's iterations, carry the weight above. What a
  // layer's particles are pushed up in a step must undo the fall g dt^2 of all layers above; so lambda grows
  // linearly.
  Scene scene = stillTank({10, 20, 10});
  scene.solver.tolerance = 0;
  scene.solver.minIterations = scene.solver.maxIterations = 1;
  scene.solver.timeStep = 0.0025;
  Simulation simulation(scene);
  constexpr int kBands = 8;
  std::vector<double> lambda(kBands, 0);
  std::vector<long> counts(kBands, 0);
  for (int frame = 0; frame < 1600; ++frame) {
    simulation.advanceFrame();
    if (frame < 1200) continue;
    const FrameView view = simulation.view();
    for (std::size_t i = 0; i < view.positions.size(); ++i) {
      // The lowest and the highest tenth feel the floor and the surface.
      const int band = static_cast<int>((static_cast<double>(view.positions[i].y) - 0.1) / 0.1);
      if (view.positions[i].y < 0.1F || band >= kBands) continue;
      lambda[static_cast<std::size_t>(band)] -= static_cast<double>(view.lambda[i]);
      ++counts[static_cast<std::size_t>(band)];
    }
  }
  double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (int band = 0; band < kBands; ++band) {
    const double x = band, y = lambda[static_cast<std::size_t>(band)] /
                               static_cast<double>(counts[static_cast<std::size_t>(band)]);
    sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
  }
  const double covariance = kBands * sxy - sx * sy;
  EXPECT_LT(covariance, 0) << "pressure must fall with height";
  const double r2 = covariance * covariance / ((kBands * sxx - sx * sx) * (kBands * syy - sy * sy));
  EXPECT_GT(r2, 0.97);
}

}  // namespace rest_test
}  // namespace migiwa
