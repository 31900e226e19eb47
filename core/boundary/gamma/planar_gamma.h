// gamma of planar walls, for a rule that says which part of a kernel an intersection of half-spaces holds.
#pragma once

#include <algorithm>

#include "core/boundary/gamma/half_spaces.h"
#include "core/boundary/gamma_method.h"
#include "core/sph/kernels.h"

namespace migiwa {

/// `Combine` takes the parts of a kernel along the axes of an intersection and returns the part inside all of
/// them.
template <class Kernel, class Combine>
class PlanarGamma final : public GammaMethod {
 public:
  explicit PlanarGamma(const GammaContext& context)
      : boundary_(context.boundary), support_(context.supportRadius) {}

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    HalfSpaces walls;
    std::vector<KernelPart> parts;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i].xyz();
      out[i] = GammaSample{};
      out[i].distance = boundary_.distance(p);
      if (out[i].distance >= support_) continue;
      walls.collect(boundary_, p, support_);
      const KernelPart fluid = fluidPart<Kernel>(walls, parts);
      out[i].gamma = std::clamp(fluid.value, 0.0F, 1.0F);
      out[i].gradient = fluid.gradient;
      out[i].pairGradient = fluidPart<PairKernel<Kernel>>(walls, parts).gradient;
    }
  }

 private:
  template <class K>
  static KernelPart fluidPart(const HalfSpaces& walls, std::vector<KernelPart>& parts) {
    kernelParts<K>(walls.tanks, parts);
    KernelPart fluid = Combine::intersection(parts);
    for (const std::vector<HalfSpace>& block : walls.blocks) {
      kernelParts<K>(block, parts);
      const KernelPart solid = Combine::intersection(parts);
      fluid.value -= solid.value;
      fluid.gradient -= solid.gradient;
    }
    return fluid;
  }

  const Boundary& boundary_;
  float support_;
};

template <class Combine>
std::unique_ptr<GammaMethod> makePlanarGamma(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<PlanarGamma<decltype(kernel), Combine>>(context);
  });
}

}  // namespace migiwa
