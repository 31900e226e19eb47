// Guards leave normal scenes alone to the last bit, and hard cases do need them.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/hard_cases/without_guards.h"

namespace migiwa::testing {
namespace {

class NormalScenes : public ::testing::TestWithParam<NormalScene> {
 protected:
  // Fits of walls that the first of the two programs makes are read by the second.
  void SetUp() override {
    std::filesystem::remove_all(cache_);
    setenv("MIGIWA_CACHE", cache_.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("MIGIWA_CACHE");
    std::filesystem::remove_all(cache_);
  }
  const std::string cache_ = ::testing::TempDir() + "migiwa_guards_" + std::to_string(getpid());
};

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
        hardCase.name != "overlap_1")
      continue;
    const Observed with = observe(sceneOf(hardCase), hardCase.until, 1);
    const std::string without = withoutGuards(hardCase, with.hash);
    EXPECT_NE(without, "same hash") << hardCase.name;
    EXPECT_NE(without, "holds") << hardCase.name;
  }
}

}  // namespace
}  // namespace migiwa::testing
