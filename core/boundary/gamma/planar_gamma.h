// gamma of planar walls, for a rule that says which part of a kernel an intersection of half-spaces holds.
#pragma once

#include <algorithm>
#include <optional>
#include <type_traits>

#include "core/boundary/gamma/flat_planes.h"
#include "core/boundary/gamma/half_spaces.h"
#include "core/boundary/gamma/product_lanes.h"
#include "core/boundary/gamma_method.h"
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
    HalfSpaces walls;
    std::vector<KernelPart> parts;
    if (flat_) {
      productOfPlanes(*flat_, kernel_, support_, points, out);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3f p = points[i].xyz();
        if (out[i].distance < 0) out[i].distance = boundary_.distance(p);
        if (!Combine::kOblique || !flat_->obliqueAt(p)) continue;
        flat_->inReach(p, walls.tanks);
        combine(walls, parts, out[i]);
      }
      return;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i].xyz();
      out[i] = GammaSample{};
      out[i].distance = boundary_.distance(p);
      if (out[i].distance >= support_) continue;
      walls.collect(boundary_, p, support_);
      combine(walls, parts, out[i]);
    }
  }

 private:
  static void combine(const HalfSpaces& walls, std::vector<KernelPart>& parts, GammaSample& sample) {
    using Pair = PairKernel<Kernel>;
    const KernelPart fluid = fluidPart<Kernel>(walls, parts, true);
    sample.gamma = std::clamp(fluid.value, 0.0F, 1.0F);
    sample.gradient = fluid.gradient;
    sample.pairGradient =
        std::is_same_v<Kernel, Pair> ? fluid.gradient : fluidPart<Pair>(walls, parts, false).gradient;
  }

  /// Without `value` only the gradient is right.
  template <class K>
  static KernelPart fluidPart(const HalfSpaces& walls, std::vector<KernelPart>& parts, bool value) {
    kernelParts<K>(walls.tanks, parts);
    KernelPart fluid = Combine::intersection(parts, value);
    for (const std::vector<HalfSpace>& block : walls.blocks) {
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

}  // namespace migiwa
