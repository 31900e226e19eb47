// gamma of two and three planes at any angle by a Gaussian copula: each plane's own gamma, in closed form, is
// exact; how they go together is taken from a Gaussian kernel, whose half-spaces are jointly normal with
// correlation n1.n2. Within 0.004 for two planes and Poly6. Further planes multiply.
#include <algorithm>
#include <cmath>

#include "core/base/normal_distribution.h"
#include "core/boundary/gamma/gamma_methods.h"
#include "core/boundary/gamma/planar_gamma.h"

namespace migiwa {

namespace {

struct Variable {
  const KernelPart* part;
  double quantile;  ///< of the part's value
};

/// P of the second, given that the first lies on its boundary.
double given(const Variable& on, const Variable& other, double r) {
  return normalCdf((other.quantile - r * on.quantile) / std::sqrt(std::max(1 - r * r, 1e-8)));
}

double correlation(const Variable& a, const Variable& b) {
  return static_cast<double>(a.part->axis.dot(b.part->axis));
}

KernelPart two(const Variable& a, const Variable& b, bool needed) {
  const double r = correlation(a, b);
  const double value = needed ? bivariateNormalCdf(a.quantile, b.quantile, r) : 0;
  return {static_cast<float>(value),
          static_cast<float>(given(a, b, r)) * a.part->gradient +
              static_cast<float>(given(b, a, r)) * b.part->gradient,
          Vec3f::Zero()};
}

/// P of the two others, given that the first lies on its boundary.
double given(const Variable& on, const Variable& b, const Variable& c) {
  const double rb = correlation(on, b), rc = correlation(on, c);
  const double sb = std::sqrt(std::max(1 - rb * rb, 1e-8)), sc = std::sqrt(std::max(1 - rc * rc, 1e-8));
  const double r = std::clamp((correlation(b, c) - rb * rc) / (sb * sc), -1.0, 1.0);
  return bivariateNormalCdf((b.quantile - rb * on.quantile) / sb, (c.quantile - rc * on.quantile) / sc, r);
}

KernelPart three(const Variable& a, const Variable& b, const Variable& c, bool needed) {
  const double value = needed ? trivariateNormalCdf(a.quantile, b.quantile, c.quantile, correlation(a, b),
                                                    correlation(a, c), correlation(b, c))
                              : 0;
  return {static_cast<float>(value),
          static_cast<float>(given(a, b, c)) * a.part->gradient +
              static_cast<float>(given(b, a, c)) * b.part->gradient +
              static_cast<float>(given(c, a, b)) * c.part->gradient,
          Vec3f::Zero()};
}

struct Copula {
  static constexpr bool kOblique = true;
  static KernelPart intersection(std::vector<KernelPart>& parts, bool value) {
    if (parts.empty()) return {1, Vec3f::Zero(), Vec3f::Zero()};
    if (parts.size() == 1) return parts.front();
    // The parts that take the most away go together exactly.
    std::sort(parts.begin(), parts.end(),
              [](const KernelPart& a, const KernelPart& b) { return a.value < b.value; });
    const auto variable = [&](std::size_t k) {
      return Variable{&parts[k], normalQuantile(static_cast<double>(parts[k].value))};
    };
    const bool needed = value || parts.size() > 3;
    KernelPart joint = parts.size() == 2 ? two(variable(0), variable(1), needed)
                                         : three(variable(0), variable(1), variable(2), needed);
    for (std::size_t k = 3; k < parts.size(); ++k) {
      joint.gradient = joint.gradient * parts[k].value + joint.value * parts[k].gradient;
      joint.value *= parts[k].value;
    }
    return joint;
  }
};

}  // namespace

std::unique_ptr<GammaMethod> makeCopulaGamma(const GammaContext& context) {
  return makePlanarGamma<Copula>(context);
}

}  // namespace migiwa
