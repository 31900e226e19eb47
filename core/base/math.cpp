#include "core/base/math.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "core/base/fields.h"

namespace migiwa {

bool Bounds::empty() const {
  return (min.array() > max.array()).any();
}

void Bounds::include(const Vec3d& p) {
  min = min.cwiseMin(p), max = max.cwiseMax(p);
}

void Bounds::include(const Bounds& other) {
  min = min.cwiseMin(other.min), max = max.cwiseMax(other.max);
}

Vec3d Bounds::center() const {
  return 0.5 * (min + max);
}

Vec3d Bounds::size() const {
  return empty() ? Vec3d(Vec3d::Zero()) : Vec3d(max - min);
}

bool Bounds::contains(const Vec3d& p) const {
  return (p.array() >= min.array()).all() && (p.array() <= max.array()).all();
}

Bounds Bounds::grown(double by) const {
  Bounds result = *this;
  result.min.array() -= by;
  result.max.array() += by;
  return result;
}

// Rotations and transforms, as scenes write them (core/base/fields.h).

Eigen::Matrix3d rotationAbout(const Vec3d& axis, double angle) {
  const double sine = portable::sin(angle), cosine = portable::cos(angle);
  Eigen::Matrix3d across;  // of the cross product with the axis
  across << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return cosine * Eigen::Matrix3d::Identity() + sine * across + (1 - cosine) * (axis * axis.transpose());
}

Eigen::Matrix3d Rotation::matrix() const {
  if (degrees == 0) return Eigen::Matrix3d::Identity();
  return rotationAbout(axis.normalized(), degrees * std::numbers::pi / 180);
}

bool Transform::operator==(const Transform& other) const {
  return scale == other.scale && rotate.axis == other.rotate.axis && rotate.degrees == other.rotate.degrees &&
         translate == other.translate;
}

Vec3f Transform::point(const Vec3f& p) const {
  return (rotate.matrix() * (scale * p.cast<double>()) + translate).cast<float>();
}

Vec3f Transform::direction(const Vec3f& n) const {
  return (rotate.matrix() * n.cast<double>()).normalized().cast<float>();
}

}  // namespace migiwa

// METHOD: an exact reduction of the argument, then the Taylor series to the last digit of a double.
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

namespace migiwa {

namespace {

/// Half of a Gauss-Legendre rule on [-1, 1]; the other half mirrors it.
struct Node {
  double at, weight;
};
constexpr std::array<Node, 3> kSixPoints{{{0.2386191860831969, 0.4679139345726910},
                                          {0.6612093864662645, 0.3607615730481386},
                                          {0.9324695142031521, 0.1713244923791704}}};
constexpr std::array<Node, 6> kTwelvePoints{{{0.1252334085114689, 0.2491470458134028},
                                             {0.3678314989981802, 0.2334925365383548},
                                             {0.5873179542866175, 0.2031674267230659},
                                             {0.7699026741943047, 0.1600783285433462},
                                             {0.9041172563704749, 0.1069393259953184},
                                             {0.9815606342467192, 0.0471753363865118}}};
constexpr std::array<Node, 10> kTwentyPoints{{{0.0765265211334973, 0.1527533871307258},
                                              {0.2277858511416451, 0.1491729864726037},
                                              {0.3737060887154195, 0.1420961093183820},
                                              {0.5108670019508271, 0.1316886384491766},
                                              {0.6360536807265150, 0.1181945319615184},
                                              {0.7463319064601508, 0.1019301198172404},
                                              {0.8391169718222188, 0.0832767415767048},
                                              {0.9122344282513259, 0.0626720483341091},
                                              {0.9639719272779138, 0.0406014298003869},
                                              {0.9931285991850949, 0.0176140071391521}}};

template <std::size_t N, class F>
double integrate(const std::array<Node, N>& rule, double a, double b, const F& f) {
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  double sum = 0;
  for (const Node& node : rule)
    sum += node.weight * (f(middle - half * node.at) + f(middle + half * node.at));
  return half * sum;
}

double normalDensity(double x) {
  return portable::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
}

/// P(X < -x) for x > 0 as slowly as needed: near zero the series sum x^(2n + 1) / (2n + 1)!! of Marsaglia
/// (2004), beyond it Laplace's continued fraction.
double tailBySums(double x) {
  constexpr int kTerms = 200;
  if (x < 1.5) {
    double term = x, sum = x;
    for (int n = 1; n < kTerms; ++n) sum += term *= x * x / (2 * n + 1);
    return 0.5 - normalDensity(x) * sum;
  }
  double fraction = x;
  for (int n = kTerms; n > 0; --n) fraction = x + n / fraction;
  return normalDensity(x) / fraction;
}

/// The tail by Taylor's series about the nearest of evenly spaced points: a table in place of the exponential
/// function.
class TailTable {
 public:
  TailTable() {
    for (int k = 0; k < kPoints; ++k) {
      const double x = k * kSpacing;
      Terms& terms = terms_[static_cast<std::size_t>(k)];
      terms[0] = tailBySums(x);
      // The n-th derivative of the density is (-1)^n He_n(x) times it; He_n+1 = x He_n - n He_n-1.
      double before = 0, hermite = 1, factorial = 1, sign = -1;
      for (std::size_t n = 1; n < terms.size(); ++n) {
        factorial *= static_cast<double>(n);
        terms[n] = sign * normalDensity(x) * hermite / factorial;
        sign = -sign;
        const double next = x * hermite - static_cast<double>(n - 1) * before;
        before = hermite, hermite = next;
      }
    }
  }
  /// P(X < -x) for x in [0, kEnd).
  double at(double x) const {
    const double point = std::floor(x / kSpacing + 0.5), t = x - point * kSpacing;
    const Terms& terms = terms_[static_cast<std::size_t>(point)];
    double sum = 0;
    for (std::size_t n = terms.size(); n-- > 0;) sum = sum * t + terms[n];
    return sum;
  }
  static constexpr double kEnd = 9;

 private:
  using Terms = std::array<double, 14>;
  static constexpr double kSpacing = 0.125;
  static constexpr int kPoints = static_cast<int>(kEnd / kSpacing) + 1;
  std::array<Terms, kPoints> terms_;
};

}  // namespace

double normalCdf(double x) {
  static const TailTable table;
  const double far = std::abs(x);
  const double tail = far < TailTable::kEnd ? table.at(far) : std::isnan(x) ? x : tailBySums(far);
  return x < 0 ? tail : 1 - tail;
}

double normalQuantile(double p) {
  p = std::clamp(p, 1e-12, 1 - 1e-12);
  // Abramowitz & Stegun 26.2.23 to 5e-4, then one step of Halley's method, which takes that to its cube.
  const double tail = std::min(p, 1 - p);
  const double t = std::sqrt(-2 * portable::log(tail));
  const double start =
      t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  const double x = p < 0.5 ? -start : start;
  const double newton = (normalCdf(x) - p) / normalDensity(x);
  return x - newton / (1 + 0.5 * x * newton);
}

double bivariateNormalCdf(double x, double y, double r) {
  if (r > 0.9999) return normalCdf(std::min(x, y));
  if (r < -0.9999) return std::max(0.0, normalCdf(x) + normalCdf(y) - 1);
  // Drezner & Wesolowsky 1990: the derivative by the correlation is the density, integrated over the angle.
  const double angle = portable::asin(r);
  const auto density = [&](double theta) {
    const double c = portable::cos(theta);
    return portable::exp(-(x * x + y * y - 2 * x * y * portable::sin(theta)) / (2 * c * c));
  };
  // The density changes faster the nearer |r| is to 1, and fastest at the far end.
  const double strength = std::abs(r), middle = 0.8 * angle;
  const double turn = strength < 0.5    ? integrate(kSixPoints, 0, angle, density)
                      : strength < 0.92 ? integrate(kTwelvePoints, 0, angle, density)
                                        : integrate(kTwentyPoints, 0, middle, density) +
                                              integrate(kTwentyPoints, middle, angle, density);
  return std::clamp(normalCdf(x) * normalCdf(y) + turn / (2 * std::numbers::pi), 0.0, 1.0);
}

double trivariateNormalCdf(double x, double y, double z, double rxy, double rxz, double ryz) {
  // Conditional on X the others are a bivariate normal pair; X runs over what matters of (-inf, x].
  constexpr double kFar = 6;
  if (x <= -kFar) return 0;
  const double sy = std::sqrt(std::max(1 - rxy * rxy, 1e-8)), sz = std::sqrt(std::max(1 - rxz * rxz, 1e-8));
  const double r = std::clamp((ryz - rxy * rxz) / (sy * sz), -1.0, 1.0);
  return integrate(kTwentyPoints, -kFar, std::min(x, kFar), [&](double t) {
    return normalDensity(t) * bivariateNormalCdf((y - rxy * t) / sy, (z - rxz * t) / sz, r);
  });
}

}  // namespace migiwa
