// The grid of a study and the fingerprints of its runs.
#include "core/study/plan.h"

#include <gtest/gtest.h>

namespace migiwa {
namespace {

StudyPlan plan() {
  return {std::string(MIGIWA_SOURCE_DIR) + "/scenes/still_tank.json",
          {{"/duration", "1"}},
          {{"/solver/max_iterations", {"3", "5"}}, {"/boundary/gamma/method", {"auto", "mean", "nearest"}}},
          0.5};
}

TEST(StudyPlan, TheLastAxisChangesFastest) {
  ASSERT_EQ(plan().size(), 6u);
  using Values = std::vector<std::string>;
  EXPECT_EQ(plan().values(1), (Values{"3", "auto"}));
  EXPECT_EQ(plan().values(2), (Values{"3", "mean"}));
  EXPECT_EQ(plan().values(3), (Values{"3", "nearest"}));
  EXPECT_EQ(plan().values(4), (Values{"5", "auto"}));
  EXPECT_EQ(plan().values(6), (Values{"5", "nearest"}));
}

TEST(StudyPlan, VariedValuesComeAfterTheCommonOnes) {
  const std::vector<Override> found = plan().overrides(5);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].pointer + found[0].value, "/duration1");
  EXPECT_EQ(found[1].pointer + found[1].value, "/solver/max_iterations5");
  EXPECT_EQ(found[2].pointer + found[2].value, "/boundary/gamma/methodmean");
}

TEST(StudyPlan, AFingerprintIsOfOneRunOfOneStudy) {
  EXPECT_EQ(runFingerprint(plan(), 1), runFingerprint(plan(), 1));
  EXPECT_NE(runFingerprint(plan(), 1), runFingerprint(plan(), 2));
  StudyPlan other = plan();
  other.until = 0.6;
  EXPECT_NE(runFingerprint(plan(), 1), runFingerprint(other, 1));
  other = plan();
  other.common.push_back({"/particle_spacing", "0.06"});
  EXPECT_NE(runFingerprint(plan(), 1), runFingerprint(other, 1));
  // What does not change a run does not change its fingerprint.
  other = plan();
  other.common.push_back({"/name", "another"});
  EXPECT_EQ(runFingerprint(plan(), 1), runFingerprint(other, 1));
}

}  // namespace
}  // namespace migiwa
