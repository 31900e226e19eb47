// Guards leave normal scenes alone to the last bit, and hard cases do need them.
#include <string>

#include <gtest/gtest.h>

#include "tests/hard_cases/without_guards.h"

namespace migiwa::testing {
namespace guard_test {

class NormalScenes : public ::testing::TestWithParam<NormalScene> {};

TEST_P(NormalScenes, HaveTheSameHashWithoutGuards) {
  const NormalRun with = normalRun(GetParam(), Guards::on);
  const NormalRun without = normalRun(GetParam(), Guards::off);
  EXPECT_EQ(with.hash, without.hash);
  EXPECT_GT(with.steps, 0);
}

INSTANTIATE_TEST_SUITE_P(Each, NormalScenes, ::testing::ValuesIn(normalScenes()),
                         [](const auto& one) { return one.param.name; });

TEST(Guards, AreMissedByHardCases) {
  // One for each guard; were the probe built with guards after all, all of them would be as they are with
  // them.
  for (const HardCase& hardCase : hardCases()) {
    if (hardCase.name != "coincident_100" && hardCase.name != "impact_wall_500" &&
        hardCase.name != "overlap_1" && hardCase.name != "head_on")
      continue;
    const Observed with = observe(sceneOf(hardCase), hardCase.until, 1);
    const std::string without = withoutGuards(hardCase, with.hash);
    EXPECT_NE(without, "same hash") << hardCase.name;
    EXPECT_NE(without, "holds") << hardCase.name;
  }
}

}  // namespace guard_test
}  // namespace migiwa::testing
