// Kulasegaram, Bonet, Lewis, Profit 2004, "A variational formulation based contact algorithm for rigid
// boundaries in two-dimensional SPH applications", Computational Mechanics 33: the density is divided by
// gamma, and gamma is a spline in the distance to the wall, fitted to a plane's. [FM] section 2 takes it as
// its starting point.
// Deviation: the paper is two-dimensional; the spline here is fitted to the plane's gamma in space. Where
// several walls are near, the nearest alone counts, for the spline knows nothing else.
#include <array>
#include <cmath>

#include "core/boundary/baselines/baselines.h"
#include "core/sph/kernels.h"

namespace migiwa {

namespace {

/// The cubic spline through gamma of a plane at even distances from 0 to the support radius, with its slope
/// at both ends; gamma(-e) = 1 - gamma(e).
class DistanceSpline {
 public:
  static constexpr std::size_t kIntervals = 8;

  template <class Kernel>
  static DistanceSpline of() {
    DistanceSpline spline;
    for (std::size_t k = 0; k <= kIntervals; ++k) spline.value_[k] = Kernel::planeGamma(at(k));
    spline.fit(Kernel::planeGammaSlope(0), Kernel::planeGammaSlope(1));
    return spline;
  }

  struct Point {
    float value, slope;
  };
  Point operator()(float e) const {
    const float distance = std::abs(e);
    if (distance >= 1) return {e > 0 ? 1.0F : 0.0F, 0};
    const float scaled = distance * static_cast<float>(kIntervals);
    const auto k = static_cast<std::size_t>(scaled);
    const float t = scaled - static_cast<float>(k), u = 1 - t;
    // Hermite's form: values and slopes at both ends of the interval.
    const float rise = value_[k + 1] - value_[k];
    const float a = kWidth * slope_[k] - rise, b = rise - kWidth * slope_[k + 1];
    const float value = u * value_[k] + t * value_[k + 1] + t * u * (a * u + b * t);
    const float slope = (rise + (u - t) * (a * u + b * t) + t * u * (b - a)) / kWidth;
    return {e >= 0 ? value : 1 - value, slope};
  }

 private:
  static constexpr float kWidth = 1.0F / kIntervals;
  static float at(std::size_t k) { return static_cast<float>(k) * kWidth; }

  /// Slopes at the inner nodes for which the second derivative is continuous: a tridiagonal system.
  void fit(float first, float last) {
    slope_.front() = first, slope_.back() = last;
    std::array<float, kIntervals + 1> factor{};
    for (std::size_t k = 1; k < kIntervals; ++k) {
      const float right = 3 * (value_[k + 1] - value_[k - 1]) / kWidth;
      const float pivot = 4 - factor[k - 1];
      factor[k] = 1 / pivot;
      slope_[k] = (right - slope_[k - 1]) / pivot;
    }
    for (std::size_t k = kIntervals - 1; k > 0; --k) slope_[k] -= factor[k] * slope_[k + 1];
  }

  std::array<float, kIntervals + 1> value_{}, slope_{};
};

class SplineGamma final : public GammaMethod {
 public:
  SplineGamma(const GammaContext& context, const DistanceSpline& density, const DistanceSpline& pair)
      : boundary_(context.boundary),
        inverseSupport_(1 / context.supportRadius),
        density_(density),
        pair_(pair) {}

  GammaChoice choice() const override {
    return {"spline", "the spline of a plane, over the distance to the nearest wall"};
  }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3f normal;
      const float distance = boundary_.distance(points[i].xyz(), normal);
      const float e = distance * inverseSupport_;
      const auto [gamma, slope] = density_(e);
      out[i] = {gamma, distance, slope * normal, pair_(e).slope * normal};
    }
  }

 private:
  const Boundary& boundary_;
  float inverseSupport_;
  DistanceSpline density_, pair_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeSplineGamma(const GammaContext& context) {
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    using Kernel = decltype(kernel);
    return std::make_unique<SplineGamma>(context, DistanceSpline::of<Kernel>(),
                                         DistanceSpline::of<PairKernel<Kernel>>());
  });
}

}  // namespace migiwa
