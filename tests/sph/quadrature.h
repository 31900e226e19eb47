// Gauss-Legendre quadrature in double: what the closed forms of core/sph/kernels.h are held against.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace migiwa::quadrature {

struct Rule {
  static constexpr std::size_t kPoints = 16;
  std::array<double, kPoints> node{}, weight{};  ///< on [-1, 1]
};

/// Nodes are the roots of the Legendre polynomial, by Newton's method from the usual cosine guess.
inline Rule makeRule() {
  Rule rule;
  constexpr auto n = static_cast<double>(Rule::kPoints);
  for (std::size_t k = 0; k < Rule::kPoints; ++k) {
    double x = std::cos(std::numbers::pi * (static_cast<double>(k) + 0.75) / (n + 0.5));
    double slope = 1;
    for (int iteration = 0; iteration < 50; ++iteration) {
      double previous = 1, value = x;
      for (std::size_t order = 2; order <= Rule::kPoints; ++order) {
        const auto degree = static_cast<double>(order);
        const double next = ((2 * degree - 1) * x * value - (degree - 1) * previous) / degree;
        previous = value;
        value = next;
      }
      slope = n * (x * value - previous) / (x * x - 1);
      x -= value / slope;
    }
    rule.node[k] = x;
    rule.weight[k] = 2 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

/// Integral of f over [a, b], cut into equal panels.
template <class F>
double integrate(double a, double b, int panels, const F& f) {
  static const Rule rule = makeRule();
  const double half = 0.5 * (b - a) / panels;
  double sum = 0;
  for (int panel = 0; panel < panels; ++panel) {
    const double middle = a + (2 * panel + 1) * half;
    for (std::size_t k = 0; k < Rule::kPoints; ++k) sum += rule.weight[k] * f(middle + half * rule.node[k]);
  }
  return sum * half;
}

}  // namespace migiwa::quadrature
