// The functions against the C library's in long double, which has eleven digits (binary) more.
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/math.h"

namespace migiwa {
namespace portable_math_test {

/// From -1 to 1, without a pattern: multiples of the golden ratio.
double spread(int k) {
  return 2 * std::fmod(k * std::numbers::phi, 1.0) - 1;
}

constexpr int kPoints = 20000;

TEST(PortableMath, SineAndCosine) {
  for (const double reach : {1e-8, 0.1, 1.0, 10.0, 1e3, 9.9e5}) {
    for (int k = 0; k < kPoints; ++k) {
      const double x = reach * spread(k);
      const auto exact = static_cast<long double>(x);
      ASSERT_NEAR(portable::sin(x), static_cast<double>(std::sin(exact)), 2e-16) << x;
      ASSERT_NEAR(portable::cos(x), static_cast<double>(std::cos(exact)), 2e-16) << x;
    }
  }
  EXPECT_EQ(portable::sin(0), 0);
  EXPECT_EQ(portable::cos(0), 1);
  for (int k = 0; k < 100; ++k) {
    const double x = 1e9 * spread(k);
    EXPECT_NEAR(portable::sin(x), std::sin(x), 1e-6) << x;
  }
  EXPECT_TRUE(std::isnan(portable::sin(std::numeric_limits<double>::infinity())));
}

TEST(PortableMath, ArcSine) {
  for (int k = 0; k < kPoints; ++k) {
    const double y = spread(k);
    const double expected = static_cast<double>(std::asin(static_cast<long double>(y)));
    ASSERT_NEAR(portable::asin(y), expected, 1e-15) << y;
  }
  EXPECT_NEAR(portable::asin(1), std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(portable::asin(0), 0);
  EXPECT_TRUE(std::isnan(portable::asin(1.0001)));
}

TEST(PortableMath, Exponential) {
  for (const double reach : {1e-8, 1.0, 30.0, 700.0}) {
    for (int k = 0; k < kPoints; ++k) {
      const double x = reach * spread(k);
      const double expected = static_cast<double>(std::exp(static_cast<long double>(x)));
      ASSERT_NEAR(portable::exp(x), expected, 4e-16 * expected) << x;
    }
  }
  EXPECT_EQ(portable::exp(0), 1);
  EXPECT_EQ(portable::exp(-1000), 0);
  EXPECT_TRUE(std::isinf(portable::exp(1000)));
  EXPECT_TRUE(std::isnan(portable::exp(std::numeric_limits<double>::quiet_NaN())));
}

TEST(PortableMath, Logarithm) {
  for (const double reach : {0.5, 3.0, 200.0, 700.0}) {
    for (int k = 0; k < kPoints; ++k) {
      const double x = std::exp(reach * spread(k));
      const double expected = static_cast<double>(std::log(static_cast<long double>(x)));
      ASSERT_NEAR(portable::log(x), expected, 2e-16 + 2e-16 * std::abs(expected)) << x;
    }
  }
  EXPECT_EQ(portable::log(1), 0);
  EXPECT_TRUE(std::isinf(portable::log(0)));
  EXPECT_TRUE(std::isnan(portable::log(-1)));
}

TEST(PortableMath, Roots) {
  for (int k = 0; k < kPoints; ++k) {
    const double x = 1e6 * spread(k);
    const double expected = static_cast<double>(std::cbrt(static_cast<long double>(x)));
    ASSERT_NEAR(portable::cbrt(x), expected, 4e-16 * std::abs(expected)) << x;
  }
  EXPECT_EQ(portable::cbrt(0), 0);
  EXPECT_EQ(portable::hypot(3, 4), 5);
  EXPECT_EQ(portable::hypot(2, 3, 6), 7);
}

}  // namespace portable_math_test
}  // namespace migiwa
