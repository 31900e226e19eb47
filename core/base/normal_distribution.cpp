#include "core/base/normal_distribution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/portable_math.h"

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
