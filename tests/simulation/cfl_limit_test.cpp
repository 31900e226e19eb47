// However short the CFL rule makes a step, a frame has a bounded number of them, and one that would need more
// says so: by the quotient itself, which no whole number holds.
#include <algorithm>

#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "tests/support/test_scenes.h"

namespace migiwa::testing {
namespace cfl_limit_test {

bool notMet(const Simulation& simulation) {
  const auto& trouble = simulation.statistics().trouble;
  return std::any_of(trouble.begin(), trouble.end(),
                     [](const Trouble& t) { return t.kind == "cfl_not_met"; });
}

class CflLimit : public ::testing::TestWithParam<double> {};

TEST_P(CflLimit, IsMetOrTold) {
  // Particles so fast for the rule's length that a frame would take 10^2 to 10^300 substeps, and more.
  Scene scene = emptyScene();
  addFluid(scene, Vec3d::Zero(), Vec3d::Constant(2 * kSpacing), {1, 0, 0});
  scene.solver.timeStep = 1;
  scene.solver.cfl = GetParam();
  Simulation simulation(scene, 1);
  simulation.advanceFrame();
  ASSERT_FALSE(simulation.stopped());
  const double wanted = 1 / (GetParam() * scene.supportRadius());
  EXPECT_EQ(notMet(simulation), wanted > 1000) << wanted;
  const auto steps = static_cast<double>(simulation.statistics().steps);
  if (wanted > 1000) {
    EXPECT_EQ(steps, 1000);
  } else {
    EXPECT_GE(steps, wanted);
    EXPECT_LT(steps, 1.5 * wanted) << "speeds change a little on the way";
  }
  EXPECT_NEAR(simulation.statistics().simulatedSeconds, 1, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Of, CflLimit, ::testing::Values(0.1, 1e-3, 1e-15, 1e-18, 1e-20, 1e-300, 5e-324));

TEST(FrameAt, HoldsTheLargestQuotient) {
  Scene scene = emptyScene();
  scene.solver.timeStep = 5e-324;
  const Simulation simulation(scene, 1);
  EXPECT_GT(simulation.frameAt(1e6), 1000000000000000L);
  EXPECT_EQ(simulation.frameAt(0), 0);
}

}  // namespace cfl_limit_test
}  // namespace migiwa::testing
