// The grid of a study and the fingerprints of its runs.
#include <gtest/gtest.h>

#include "core/study/study.h"

namespace migiwa {
namespace plan_test {

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

TEST(StudyPlan, SettingsThatBelongTogetherVaryAsOne) {
  StudyPlan together = plan();
  together.axes = {{"/boundary/handling:/boundary/gamma/method", {"gamma:mean", "particles"}}};
  ASSERT_EQ(together.size(), 2u);
  const std::vector<Override> both = together.overrides(1), one = together.overrides(2);
  ASSERT_EQ(both.size(), 3u);
  EXPECT_EQ(both[1].pointer + "=" + both[1].value, "/boundary/handling=gamma");
  EXPECT_EQ(both[2].pointer + "=" + both[2].value, "/boundary/gamma/method=mean");
  ASSERT_EQ(one.size(), 2u) << "the other pointer stays as it is";
  EXPECT_EQ(one[1].pointer + "=" + one[1].value, "/boundary/handling=particles");
  EXPECT_EQ(together.axes[0].label("gamma:mean"), "mean");
  EXPECT_EQ(together.axes[0].label("particles"), "particles");
  // A colon in a value of one pointer is the value's own.
  const StudyAxis object{"/effects", {R"({"viscosity":{"xsph":0.1}})"}};
  ASSERT_EQ(object.overrides(object.values[0]).size(), 1u);
  EXPECT_EQ(object.overrides(object.values[0])[0].value, object.values[0]);
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

}  // namespace plan_test
}  // namespace migiwa
