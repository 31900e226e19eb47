#include <array>

#include <gtest/gtest.h>

#include "core/base/messages.h"

namespace migiwa {
namespace nearest_name_test {

TEST(EditDistance, CountsLetters) {
  EXPECT_EQ(editDistance("", ""), 0);
  EXPECT_EQ(editDistance("", "abc"), 3);
  EXPECT_EQ(editDistance("abc", ""), 3);
  EXPECT_EQ(editDistance("tolerance", "tolerance"), 0);
  EXPECT_EQ(editDistance("tolerence", "tolerance"), 1);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3);
  EXPECT_EQ(editDistance("ab", "ba"), 1);  // a swap
  EXPECT_EQ(editDistance("gravtiy", "gravity"), 1);
}

TEST(NearestName, TakesTheFirstOfTheNearest) {
  const std::array<std::string_view, 3> names{"min", "max", "mix"};
  EXPECT_EQ(nearestName("mim", names), "min");
  EXPECT_EQ(nearestName("mix", names), "mix");
  EXPECT_EQ(nearestName("mx", names), "max");
  EXPECT_EQ(nearestName("x", {}), "");
}

TEST(NearestName, SurvivesAVeryLongWord) {
  const std::array<std::string_view, 2> names{"solver", "view"};
  EXPECT_EQ(nearestName(std::string(1000000, 'v'), names), "solver");
}

}  // namespace nearest_name_test
}  // namespace migiwa
