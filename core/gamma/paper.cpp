// gamma of the closest wall alone. Right on one plane, off by up to 1/4 at a right-angled edge.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/math.h"
#include "core/gamma/gamma_method.h"
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

// [FM] Eq. 14: gamma is the mean of the pieces' own gammas, weighted by a Gaussian of the distance to the
// node's centre. Pieces without a node have their foot point as centre; those nearer than h count, sigma =
// h/2. Off by up to 1/4 at a right-angled edge whatever the weights: the error of the paper's Figure 3.

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

// gamma by sampling the kernel: the share of samples that lie in the fluid. Slow; the reference for the
// others. The samples are a fixed quasi-random set (Roberts' R3 sequence), drawn with the density of the
// kernel itself, so the error falls nearly as 1/samples and neighbouring points share it.

namespace {

template <class Kernel>
class MonteCarloGamma final : public GammaMethod {
 public:
  explicit MonteCarloGamma(const GammaContext& context)
      : boundary_(context.boundary), support_(context.supportRadius) {
    for (const auto& surface : boundary_.surfaces())
      if (surface->thickness() < support_) thin_.push_back(surface.get());
    // 1/g, 1/g^2, 1/g^3 for the real root g of g^4 = g + 1.
    constexpr double kGolden = 1.2207440846057596;
    double a = 0.5, b = 0.5, c = 0.5;
    for (int k = 0; k < context.samples; ++k) {
      a += 1 / kGolden, b += 1 / (kGolden * kGolden), c += 1 / (kGolden * kGolden * kGolden);
      a -= std::floor(a), b -= std::floor(b), c -= std::floor(c);
      const double z = 1 - 2 * a, across = std::sqrt(std::max(1 - z * z, 0.0)),
                   angle = 2 * std::numbers::pi * b;
      const Vec3f direction(static_cast<float>(across * portable::cos(angle)),
                            static_cast<float>(across * portable::sin(angle)), static_cast<float>(z));
      const float r = radiusOfMass(static_cast<float>(c));
      const float density = std::max(Kernel::value(r), 1e-20F);
      samples_.push_back({r * direction, -Kernel::derivative(r) / density * direction,
                          -PairKernel<Kernel>::derivative(r) / density * direction});
    }
  }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i].xyz();
      out[i] = GammaSample{};
      out[i].distance = boundary_.distance(p);
      if (out[i].distance >= support_) continue;
      // The solid's part of the gradient is minus the fluid's, and has fewer samples near most walls.
      long solid = 0;
      Vec3d gradient = Vec3d::Zero(), pairGradient = Vec3d::Zero();
      for (const Sample& sample : samples_) {
        if (sees(p, p + support_ * sample.offset)) continue;
        ++solid;
        gradient -= sample.slope.template cast<double>();
        pairGradient -= sample.pairSlope.template cast<double>();
      }
      const double count = static_cast<double>(samples_.size());
      out[i].gamma = static_cast<float>(1 - static_cast<double>(solid) / count);
      out[i].gradient = (gradient / count).template cast<float>();
      out[i].pairGradient = (pairGradient / count).template cast<float>();
    }
  }

 private:
  struct Sample {
    Vec3f offset;            ///< over the support radius
    Vec3f slope, pairSlope;  ///< what it adds to h grad gamma, with the number of samples still to divide by
  };

  /// Whether a place is fluid, and not hidden by a thin wall.
  bool sees(const Vec3f& p, const Vec3f& place) const {
    return boundary_.distance(place) >= 0 &&
           std::none_of(thin_.begin(), thin_.end(),
                        [&](const Surface* thin) { return thin->hides(p, place); });
  }

  static float radiusOfMass(float mass) {
    float low = 0, high = 1;
    for (int step = 0; step < 30; ++step) {
      const float middle = 0.5F * (low + high);
      (RadialIntegrals<Kernel>::mass(middle) < mass ? low : high) = middle;
    }
    return 0.5F * (low + high);
  }

  const Boundary& boundary_;
  float support_;
  std::vector<const Surface*> thin_;
  std::vector<Sample> samples_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeMonteCarloGamma(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<MonteCarloGamma<decltype(kernel)>>(context);
  });
}

}  // namespace migiwa
