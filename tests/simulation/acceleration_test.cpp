// The Chebyshev weights against their closed form, and what they are for: fewer iterations, and the same
// rest.
#include <cmath>

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "core/solver/state.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace acceleration_test {

using namespace migiwa::testing;

TEST(Chebyshev, WeightsGoToTheirLimit) {
  Chebyshev weights;
  // Far from the tolerance, every step is stretched.
  std::vector<IterationError> errors{{1.0, 1.0}};
  std::vector<float> found;
  for (int k = 0; k < 50; ++k) {
    found.push_back(weights.next(errors, 1e-9));
    errors.push_back({errors.back().mean * 0.99, 1.0});
  }
  EXPECT_EQ(found[0], 1);
  EXPECT_EQ(found[1], 1);
  EXPECT_FLOAT_EQ(found[2], 2 / (2 - 0.81F));
  // The fixed point of w = 4 / (4 - rho^2 w) is 2 / (1 + sqrt(1 - rho^2)).
  EXPECT_NEAR(found.back(), 2 / (1 + std::sqrt(1 - 0.81)), 1e-5);
}

TEST(Chebyshev, TheIterationThatIsAboutToEndTheSolveIsPlain) {
  const std::vector<IterationError> errors{{0.08, 1}, {0.04, 1}, {0.02, 1}};
  EXPECT_EQ(Chebyshev().next(errors, 0.0101), 1) << "halved again, the error is within the tolerance";
  EXPECT_GT(Chebyshev().next(errors, 0.0099), 1);
}

double meanIterations(Acceleration acceleration) {
  Scene scene = stillTank({10, 20, 10});
  scene.solver.timeStep = 1.0 / 120;
  scene.solver.maxIterations = 100;
  scene.solver.acceleration = acceleration;
  Simulation simulation(scene, 2);
  long iterations = 0;
  constexpr int kFrames = 60;
  for (int k = 0; k < kFrames; ++k) {
    simulation.advanceFrame();
    iterations += simulation.view().info.iterations;
    EXPECT_LE(simulation.view().info.errors.back().mean, scene.solver.tolerance);
  }
  return static_cast<double>(iterations) / kFrames;
}

TEST(Chebyshev, TakesAThirdOfTheIterationsAway) {
  EXPECT_LT(meanIterations(Acceleration::chebyshev), 0.7 * meanIterations(Acceleration::none));
}

}  // namespace acceleration_test
}  // namespace migiwa
