// [FM] Eq. 14: gamma is the mean of the pieces' own gammas, weighted by a Gaussian of the distance to the
// node's centre. Pieces without a node have their foot point as centre; those nearer than h count, sigma =
// h/2. Off by up to 1/4 at a right-angled edge whatever the weights: the error of the paper's Figure 3.
#include <cmath>

#include "core/base/portable_math.h"
#include "core/boundary/gamma/gamma_methods.h"
#include "core/sph/kernels.h"

namespace migiwa {

namespace {

template <class Kernel>
class MeanGamma final : public GammaMethod {
 public:
  explicit MeanGamma(const GammaContext& context)
      : boundary_(context.boundary), support_(context.supportRadius) {}

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    std::vector<WallPiece> pieces;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i].xyz();
      out[i] = GammaSample{};
      out[i].distance = boundary_.distance(p);
      pieces.clear();
      for (const auto& surface : boundary_.surfaces()) surface->pieces(p, support_, pieces);
      Sums sums;
      for (const WallPiece& piece : pieces) add(piece, p, sums);
      if (sums.weight <= 0) continue;
      // gamma = S / w, so grad gamma = (grad S - gamma grad w) / w.
      out[i].gamma = sums.gamma / sums.weight;
      out[i].gradient = (sums.gradient - out[i].gamma * sums.weightGradient) / sums.weight;
      out[i].pairGradient =
          (sums.pairGradient - sums.pairGamma / sums.weight * sums.weightGradient) / sums.weight;
    }
  }

 private:
  struct Sums {
    float weight = 0, gamma = 0, pairGamma = 0;
    Vec3f weightGradient = Vec3f::Zero(), gradient = Vec3f::Zero(), pairGradient = Vec3f::Zero();
  };

  void add(const WallPiece& piece, const Vec3f& p, Sums& sums) const {
    using Pair = PairKernel<Kernel>;
    const Vec3f offset = (p - piece.foot) / support_;
    const float squared = offset.squaredNorm();
    if (squared >= 1) return;
    const auto weight = static_cast<float>(portable::exp(-2 * static_cast<double>(squared)));
    // Moving the point moves the foot with it along the piece; the rest of the offset grows one for one.
    const Vec3f weightGradient = -4 * weight * offset;
    const float e = piece.planeDistance / support_;
    const float gamma = Kernel::planeGamma(e), pairGamma = Pair::planeGamma(e);
    sums.weight += weight;
    sums.weightGradient += weightGradient;
    sums.gamma += weight * gamma;
    sums.pairGamma += weight * pairGamma;
    sums.gradient += weight * Kernel::planeGammaSlope(e) * piece.normal + gamma * weightGradient;
    sums.pairGradient += weight * Pair::planeGammaSlope(e) * piece.normal + pairGamma * weightGradient;
  }

  const Boundary& boundary_;
  float support_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeMeanGamma(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<MeanGamma<decltype(kernel)>>(context);
  });
}

}  // namespace migiwa
