#include <cmath>

#include <gtest/gtest.h>

#include "core/base/fields.h"

namespace migiwa {
namespace range_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Range, AClosedEndBelongsToItAndAnOpenOneDoesNot) {
  const Range closed = Range::closed(1, 2);
  EXPECT_TRUE(closed.contains(1));
  EXPECT_TRUE(closed.contains(2));
  const Range halfOpen = Range::halfOpen(1, 2);
  EXPECT_TRUE(halfOpen.contains(1));
  EXPECT_TRUE(halfOpen.contains(std::nextafter(2, 0)));
  EXPECT_FALSE(halfOpen.contains(2));
  const Range positive = Range::positive(5);
  EXPECT_FALSE(positive.contains(0));
  EXPECT_TRUE(positive.contains(std::numeric_limits<double>::denorm_min()));
  EXPECT_TRUE(positive.contains(5));
  EXPECT_FALSE(positive.contains(std::nextafter(5, 6)));
}

TEST(Range, HoldsNoNaN) {
  EXPECT_FALSE(Range::closed(0, 1).contains(std::nan("")));
  EXPECT_FALSE(Range{}.contains(std::nan("")));
}

TEST(Range, TextSaysWhichEndsBelongToIt) {
  EXPECT_EQ(Range::closed(0, 1).text(), "in [0, 1]");
  EXPECT_EQ(Range::halfOpen(0, 1).text(), "in [0, 1)");
  EXPECT_EQ(Range::positive(4).text(), "in (0, 4]");
  EXPECT_EQ((Range{1, kInfinity}.text()), "at least 1");
  EXPECT_EQ((Range{0, kInfinity, true}.text()), "more than 0");
  EXPECT_EQ((Range{-kInfinity, 3}.text()), "at most 3");
  EXPECT_EQ((Range{-kInfinity, 3, false, true}.text()), "less than 3");
  EXPECT_EQ(Range{}.text(), "of any size");
}

TEST(Range, CoordinatesReachTheLimitOnBothSides) {
  EXPECT_TRUE(kCoordinateRange.contains(kLargestCoordinate));
  EXPECT_TRUE(kCoordinateRange.contains(-kLargestCoordinate));
  EXPECT_FALSE(kCoordinateRange.contains(std::nextafter(kLargestCoordinate, kInfinity)));
}

}  // namespace range_test
}  // namespace migiwa
