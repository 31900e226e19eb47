// METHOD: an exact reduction of the argument, then the Taylor series to the last digit of a double.
#include "core/base/portable_math.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace migiwa::portable {

namespace {

/// pi/2 and log 2, their leading 33 digits (binary) and the rest: a multiple of the first by less than 2^20
/// is exact.
constexpr double kQuarterTurn = 0x1.921fb544p+0, kQuarterTurnRest = 0x1.0b4611a626331p-34;
constexpr double kLog2 = 0x1.62e42fefp-1, kLog2Rest = 0x1.473de6af278edp-34;

/// sum of terms[k] x^k.
template <std::size_t N>
constexpr double polynomial(const std::array<double, N>& terms, double x) {
  double sum = 0;
  for (std::size_t k = N; k-- > 0;) sum = sum * x + terms[k];
  return sum;
}

/// 1/first!, -1/(first+2)!, 1/(first+4)!, ...
template <std::size_t N>
constexpr std::array<double, N> alternatingFactorials(int first) {
  std::array<double, N> terms{};
  double factorial = 1;
  for (int k = 2; k <= first; ++k) factorial *= k;
  for (std::size_t k = 0; k < N; ++k) {
    terms[k] = (k % 2 == 0 ? 1 : -1) / factorial;
    const int next = first + 2 * static_cast<int>(k);
    factorial *= (next + 1.0) * (next + 2.0);
  }
  return terms;
}

/// Of |x| < pi/4 and a little.
double sineNearZero(double x) {
  static constexpr auto kTerms = alternatingFactorials<8>(3);
  const double x2 = x * x;
  return x - x * x2 * polynomial(kTerms, x2);
}
double cosineNearZero(double x) {
  static constexpr auto kTerms = alternatingFactorials<8>(4);
  const double x2 = x * x;
  return 1 - (0.5 * x2 - x2 * x2 * polynomial(kTerms, x2));
}

/// The sine of an angle that is `turns` quarters further on.
double sineAfter(double angle, int turns) {
  if (!std::isfinite(angle)) return std::numeric_limits<double>::quiet_NaN();
  constexpr double kMost = 1e6;
  const double within = std::abs(angle) < kMost ? angle : std::fmod(angle, 2 * std::numbers::pi);
  const double quarters = std::round(within / (kQuarterTurn + kQuarterTurnRest));
  const double x = (within - quarters * kQuarterTurn) - quarters * kQuarterTurnRest;
  const int quadrant = (static_cast<int>(quarters) + turns) & 3;
  const double value = quadrant % 2 == 0 ? sineNearZero(x) : cosineNearZero(x);
  return quadrant < 2 ? value : -value;
}

}  // namespace

double sin(double angle) {
  return sineAfter(angle, 0);
}

double cos(double angle) {
  return sineAfter(angle, 1);
}

double asin(double y) {
  if (!(std::abs(y) <= 1)) return std::numeric_limits<double>::quiet_NaN();
  // The sine of half the angle, three times: then |y| < 0.2.
  constexpr int kHalvings = 3;
  double x = y;
  for (int k = 0; k < kHalvings; ++k) x /= std::sqrt(2 * (1 + std::sqrt((1 - x) * (1 + x))));
  // (2n)! / (4^n n!^2 (2n + 1)) x^(2n + 1).
  static constexpr auto kTerms = [] {
    std::array<double, 11> terms{};
    double part = 1;
    for (std::size_t n = 0; n < terms.size(); ++n) {
      const auto twice = 2 * static_cast<double>(n);
      if (n > 0) part *= (twice - 1) / twice;
      terms[n] = part / (twice + 1);
    }
    return terms;
  }();
  return (1 << kHalvings) * (x * polynomial(kTerms, x * x));
}

double exp(double x) {
  if (std::isnan(x)) return x;
  if (x > 709) return std::numeric_limits<double>::infinity();
  if (x < -708) return 0;
  const double doublings = std::round(x / (kLog2 + kLog2Rest));
  const double rest = (x - doublings * kLog2) - doublings * kLog2Rest;
  static constexpr auto kTerms = [] {
    std::array<double, 14> terms{};
    double factorial = 1;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      terms[k] = 1 / factorial;
      factorial *= static_cast<double>(k + 1);
    }
    return terms;
  }();
  // 2^doublings by its exponent, a number that is not subnormal.
  const auto exponent = static_cast<std::uint64_t>(static_cast<std::int64_t>(doublings) + 1023);
  return polynomial(kTerms, rest) * std::bit_cast<double>(exponent << 52U);
}

double log(double x) {
  if (!(x >= 0)) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0) return -std::numeric_limits<double>::infinity();
  if (std::isinf(x)) return x;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < std::numbers::sqrt2 / 2) mantissa *= 2, --exponent;
  // 2 artanh(s), s at most 0.172.
  const double s = (mantissa - 1) / (mantissa + 1);
  static constexpr auto kTerms = [] {
    std::array<double, 10> terms{};
    for (std::size_t k = 0; k < terms.size(); ++k) terms[k] = 2 / (2 * static_cast<double>(k) + 3);
    return terms;
  }();
  const double s2 = s * s;
  return exponent * kLog2 + (exponent * kLog2Rest + (2 * s + s * s2 * polynomial(kTerms, s2)));
}

double cbrt(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  const double size = std::abs(x);
  const double guess = exp(log(size) / 3);
  // One step of Newton's takes the rounding of the guess to its square.
  return std::copysign(guess - (guess - size / (guess * guess)) / 3, x);
}

double hypot(double x, double y, double z) {
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace migiwa::portable
