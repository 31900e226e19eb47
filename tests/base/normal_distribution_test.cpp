// The normal distribution against quadrature of its density.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "tests/sph/quadrature.h"

namespace migiwa {
namespace normal_distribution_test {

double density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
}

TEST(NormalDistribution, QuantileUndoesTheDistribution) {
  for (const double p : {1e-9, 1e-6, 0.001, 0.02, 0.3, 0.5, 0.77, 0.999, 1 - 1e-7})
    EXPECT_NEAR(normalCdf(normalQuantile(p)), p, 1e-8 * std::min(p, 1 - p) + 1e-15) << p;
}

TEST(NormalDistribution, TailsKeepTheirDigits) {
  for (int k = -9500; k <= 9500; ++k) {
    const double x = 0.001 * k;
    const double expected = static_cast<double>(
        0.5L * std::erfc(-static_cast<long double>(x) / std::numbers::sqrt2_v<long double>));
    ASSERT_NEAR(normalCdf(x), expected, 2e-14 * expected) << x;
  }
}

TEST(NormalDistribution, TwoVariablesTogether) {
  for (const double r : {0.0, 0.3, 0.499, 0.5, 0.75, 0.866, 0.919, 0.93, 0.98, 0.99}) {
    for (const double sign : {-1.0, 1.0}) {
      for (const double x : {-2.5, -1.0, -0.1, 0.4, 1.7, 3.5}) {
        for (const double y : {-3.0, -0.7, 0.0, 0.6, 2.2}) {
          const double spread = std::sqrt(1 - r * r);
          const double expected = quadrature::integrate(-9, x, 400, [&](double t) {
            return density(t) * 0.5 * std::erfc(-(y - sign * r * t) / spread / std::numbers::sqrt2);
          });
          EXPECT_NEAR(bivariateNormalCdf(x, y, sign * r), expected, 1e-7) << x << " " << y << " " << sign * r;
        }
      }
    }
  }
}

}  // namespace normal_distribution_test
}  // namespace migiwa
