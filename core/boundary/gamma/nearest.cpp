// gamma of the closest wall alone. Right on one plane, off by up to 1/4 at a right-angled edge.
#include "core/boundary/gamma/gamma_methods.h"
#include "core/sph/kernels.h"

namespace migiwa {

namespace {

template <class Kernel>
class NearestGamma final : public GammaMethod {
 public:
  explicit NearestGamma(const GammaContext& context)
      : boundary_(context.boundary), inverseSupport_(1 / context.supportRadius) {}

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3f normal;
      const float distance = boundary_.distance(points[i].xyz(), normal);
      const float e = distance * inverseSupport_;
      out[i] = {Kernel::planeGamma(e), distance, Kernel::planeGammaSlope(e) * normal,
                PairKernel<Kernel>::planeGammaSlope(e) * normal};
    }
  }

 private:
  const Boundary& boundary_;
  float inverseSupport_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeNearestGamma(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<NearestGamma<decltype(kernel)>>(context);
  });
}

}  // namespace migiwa
