// gamma of planar walls, for a rule that says which part of a kernel an intersection of half-spaces holds.
#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "core/base/math.h"
#include "core/gamma/batches.h"
#include "core/gamma/gamma_method.h"
#include "core/gamma/half_spaces.h"
#include "core/sph/kernels.h"

namespace migiwa {

/// `Combine` takes the parts of a kernel along the axes of an intersection and returns the part inside all of
/// them, or only that part's gradient. At right angles that is their product; kOblique: at other angles it is
/// something else.
template <class Kernel, class Combine>
class PlanarGamma final : public GammaMethod {
 public:
  explicit PlanarGamma(const GammaContext& context)
      : boundary_(context.boundary),
        kernel_(context.kernel),
        support_(context.supportRadius),
        flat_(FlatPlanes::of(boundary_, support_)) {}

  void wallsMoved() override { flat_ = FlatPlanes::of(boundary_, support_); }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    if (flat_) {
      HalfSpaces walls;
      std::vector<KernelPart> parts;
      productOfPlanes(*flat_, kernel_, support_, points, out);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3f p = points[i].xyz();
        if (out[i].distance < 0) out[i].distance = boundary_.distance(p);
        if (!Combine::kOblique || !flat_->obliqueAt(p)) continue;
        flat_->inReach(p, walls.tanks());
        combine(walls, parts, out[i]);
      }
      return;
    }
    measure(boundary_, points, out);
    evaluateMeasured(points, out);
  }

  void evaluateMeasured(std::span<const Float4> points, std::span<GammaSample> out) const override {
    if (flat_) return evaluate(points, out);
    HalfSpaces walls;
    std::vector<KernelPart> parts;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (out[i].distance >= support_) continue;
      walls.collect(boundary_, points[i].xyz(), support_);
      combine(walls, parts, out[i]);
    }
  }

 private:
  void combine(const HalfSpaces& walls, std::vector<KernelPart>& parts, GammaSample& sample) const {
    using Pair = PairKernel<Kernel>;
    const KernelPart fluid = fluidPart<Kernel>(walls, parts, true);
    range_.set(sample, fluid.value);
    sample.gradient = fluid.gradient;
    sample.pairGradient =
        std::is_same_v<Kernel, Pair> ? fluid.gradient : fluidPart<Pair>(walls, parts, false).gradient;
  }

  /// Without `value` only the gradient is right.
  template <class K>
  static KernelPart fluidPart(const HalfSpaces& walls, std::vector<KernelPart>& parts, bool value) {
    kernelParts<K>(walls.tanks(), parts);
    KernelPart fluid = Combine::intersection(parts, value);
    for (const std::vector<HalfSpace>& block : walls.blocks()) {
      kernelParts<K>(block, parts);
      const KernelPart solid = Combine::intersection(parts, value);
      fluid.value -= solid.value;
      fluid.gradient -= solid.gradient;
    }
    return fluid;
  }

  const Boundary& boundary_;
  KernelType kernel_;
  float support_;
  std::optional<FlatPlanes> flat_;
};

template <class Combine>
std::unique_ptr<GammaMethod> makePlanarGamma(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<PlanarGamma<decltype(kernel), Combine>>(context);
  });
}

// gamma as the product over planes at right angles. Exact for one plane and for parallel planes; within 0.004
// on a right-angled edge and 0.008 in a corner for Poly6, which is nearly a Gaussian and so nearly separates.

namespace {

struct Product {
  static constexpr bool kOblique = false;
  static KernelPart intersection(std::span<const KernelPart> parts, bool /*value*/) {
    KernelPart product{1, Vec3f::Zero(), Vec3f::Zero()};
    for (const KernelPart& part : parts) {
      product.gradient = product.gradient * part.value + product.value * part.gradient;
      product.value *= part.value;
    }
    return product;
  }
};

}  // namespace

std::unique_ptr<GammaMethod> makeProductGamma(const GammaContext& context) {
  return makePlanarGamma<Product>(context);
}

// gamma of two and three planes at any angle by a Gaussian copula: each plane's own gamma, in closed form, is
// exact; how they go together is taken from a Gaussian kernel, whose half-spaces are jointly normal with
// correlation n1.n2. Within 0.004 for two planes and Poly6. Further planes multiply.

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
