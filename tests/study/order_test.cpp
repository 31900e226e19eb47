// Orders of errors that follow a power by construction, and the lines of a study that they are taken from.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/study/study.h"

namespace migiwa {
namespace order_test {

TEST(MeasuredOrder, IsThePowerThatTheErrorFollows) {
  for (const double power : {2.0, 1.0, -0.5}) {
    std::array<ValueAndError, 4> points{};
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double value = 0.1 / static_cast<double>(k + 1);
      points[k] = {value, 3 * std::pow(value, power)};
    }
    EXPECT_NEAR(*measuredOrder(points), power, 1e-12);
  }
}

TEST(MeasuredOrder, IsTheSlopeOfTheBestLineThroughScatter) {
  // ln errors 0, 1, 0 above the line of order 1 over values 1, e, e^2: the mean rises, the slope stays.
  const double e = std::exp(1.0);
  EXPECT_NEAR(*measuredOrder(std::array<ValueAndError, 3>{{{1, 1}, {e, e * e}, {e * e, e * e}}}), 1, 1e-12);
}

TEST(MeasuredOrder, NeedsThreeValuesAndLeavesOutWhatHasNoLogarithm) {
  EXPECT_FALSE(measuredOrder(std::array<ValueAndError, 2>{{{1, 1}, {2, 2}}}));
  EXPECT_FALSE(measuredOrder(std::array<ValueAndError, 4>{{{1, 1}, {2, 2}, {2, 3}, {0, 4}}}));
  EXPECT_NEAR(*measuredOrder(std::array<ValueAndError, 4>{{{1, 1}, {2, 2}, {4, 4}, {8, 0}}}), 1, 1e-12);
}

TEST(Convergence, HasALineForEachCombinationOfTheOtherValues) {
  const StudyPlan plan{"tank.json",
                       {},
                       {{"/boundary/handling:/boundary/gamma/method", {"gamma:mean", "none"}},
                        {"/particle_spacing", {"0.1", "0.2", "0.4"}},
                        {"/solver/substeps", {"1", "2"}}},
                       1};
  EXPECT_EQ(convergenceAxes(plan), (std::vector<std::size_t>{1})) << "two values show no order";
  std::vector<FinishedRun> runs;
  for (std::size_t run = 1; run <= plan.size(); ++run) {
    const std::vector<std::string> values = plan.values(run);
    const double spacing = std::stod(values[1]);
    RunRecord record;
    record.measures = {{"density_error_mean", values[0] == "none" ? spacing : spacing * spacing}};
    if (values[0] == "none" && values[1] == "0.2" && values[2] == "2") record.trouble = "lost_particle";
    runs.push_back({run, values, record});
  }
  const std::vector<ConvergenceLine> lines = convergenceOf(plan, runs, 1, accuracyMeasures().front());
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0].label, "mean, substeps 1");
  EXPECT_NEAR(*lines[0].order, 2, 1e-12);
  EXPECT_EQ(lines[2].label, "none, substeps 1");
  EXPECT_NEAR(*lines[2].order, 1, 1e-12);
  EXPECT_EQ(lines[3].points.size(), 2U) << "a run that failed has no error";
  EXPECT_FALSE(lines[3].order);
}

}  // namespace order_test
}  // namespace migiwa
