#include <cmath>

#include <gtest/gtest.h>

#include "core/base/messages.h"

namespace migiwa {
namespace number_text_test {

TEST(NumberTextTest, GroupsDigitsByThree) {
  EXPECT_EQ(groupedDigits(0), "0");
  EXPECT_EQ(groupedDigits(999), "999");
  EXPECT_EQ(groupedDigits(1000), "1,000");
  EXPECT_EQ(groupedDigits(1234567), "1,234,567");
}

TEST(NumberTextTest, MillisecondsKeepThreeDigits) {
  EXPECT_EQ(milliseconds(0.0012345, true), "1.23");
  EXPECT_EQ(milliseconds(0.009996, true), "10.0");
  EXPECT_EQ(milliseconds(0.0123, true), "12.3");
  EXPECT_EQ(milliseconds(0.123, true), "123");
  EXPECT_EQ(milliseconds(0.123, false), "–");
}

TEST(NumberTextTest, TicksAreRoundNumbersInTheRange) {
  const Ticks density = roundTicks(0.6, 1.2, 6);
  ASSERT_EQ(density.values.size(), 7U);
  EXPECT_NEAR(density.values.front(), 0.6, 1e-12);
  EXPECT_NEAR(density.values.back(), 1.2, 1e-12);
  EXPECT_EQ(density.decimals, 1);

  const Ticks speed = roundTicks(0, 6, 6);
  EXPECT_EQ(speed.values, (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(speed.decimals, 0);

  const Ticks lambda = roundTicks(-0.02, 0, 6);
  EXPECT_NEAR(lambda.values.front(), -0.02, 1e-12);
  EXPECT_FALSE(std::signbit(lambda.values.back())) << "no minus before zero";
  EXPECT_EQ(lambda.decimals, 3);
}

}  // namespace number_text_test
}  // namespace migiwa
