// Kulasegaram, Bonet, Lewis, Profit 2004, "A variational formulation based contact algorithm for rigid
// boundaries in two-dimensional SPH applications", Computational Mechanics 33: the density is divided by
// gamma, and gamma is a spline in the distance to the wall, fitted to a plane's. [FM] section 2 takes it as
// its starting point.
// Deviation: the paper is two-dimensional; the spline here is fitted to the plane's gamma in space. Where
// several walls are near, the nearest alone counts, for the spline knows nothing else.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/gamma/gamma_method.h"
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

// Harada, Koshizuka, Kawaguchi 2007, "Smoothed Particle Hydrodynamics in Complex Shapes" (SCCG; also
// "Improvement of the Boundary Conditions in Smoothed Particle Hydrodynamics", CGG 2007): the wall is thought
// of as full of particles at rest, and what they add to the density, the wall weight function Z(d), is summed
// once for a table over the distance: rho_i = S_i + Z(d_i). The wall particles lie on the lattice of the
// fluid at rest, its first layer half a spacing behind the wall and one of its axes through the fluid
// particle: a lattice that rests on a flat wall goes on in it, and reads the density at rest.
// Deviation: the paper pushes particles out by their depth in the wall; here the gradient of Z pushes, so
// that all handlings meet in the same solver. Where several walls are near, the nearest alone counts.

namespace {

struct Weight {
  float value = 0;      ///< Z / rho0
  float slope = 0;      ///< its derivative times the support radius
  float pairSlope = 0;  ///< the same with the kernel of the pair gradients
};

/// Z over distances from 0 to the support radius, linear in between.
class WeightTable {
 public:
  template <class Kernel>
  static WeightTable of(double spacing, double massRatio) {
    WeightTable table;
    for (std::size_t k = 0; k <= kIntervals; ++k)
      table.weights_[k] = sum<Kernel>(static_cast<double>(k) / kIntervals, spacing, massRatio);
    return table;
  }

  Weight operator()(float e) const {
    const float scaled = std::clamp(e, 0.0F, 1.0F) * static_cast<float>(kIntervals);
    const std::size_t k = std::min(static_cast<std::size_t>(scaled), kIntervals - 1);
    const float t = scaled - static_cast<float>(k);
    const Weight &a = weights_[k], &b = weights_[k + 1];
    return {a.value + t * (b.value - a.value), a.slope + t * (b.slope - a.slope),
            a.pairSlope + t * (b.pairSlope - a.pairSlope)};
  }

 private:
  static constexpr std::size_t kIntervals = 256;

  /// Over the wall particles; lengths over the support radius.
  template <class Kernel>
  static Weight sum(double distance, double spacing, double massRatio) {
    const int reach = static_cast<int>(std::ceil(1 / spacing));
    double value = 0, slope = 0, pairSlope = 0;
    for (int layer = 0; layer <= reach; ++layer) {
      const double depth = distance + (layer + 0.5) * spacing;
      for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
          const double q = std::sqrt(depth * depth + spacing * spacing * (i * i + j * j));
          if (q >= 1) continue;
          const auto at = static_cast<float>(q);
          value += static_cast<double>(Kernel::value(at));
          slope += static_cast<double>(Kernel::derivative(at)) * depth / q;
          pairSlope += static_cast<double>(PairKernel<Kernel>::derivative(at)) * depth / q;
        }
      }
    }
    return {static_cast<float>(massRatio * value), static_cast<float>(massRatio * slope),
            static_cast<float>(massRatio * pairSlope)};
  }

  std::array<Weight, kIntervals + 1> weights_;
};

class WallWeight final : public GammaMethod {
 public:
  WallWeight(const GammaContext& context, const WeightTable& table)
      : GammaMethod(WallDensity::added),
        boundary_(context.boundary),
        inverseSupport_(1 / context.supportRadius),
        table_(table) {}

  GammaChoice choice() const override {
    return {"wall_weight", "a table over the distance to the nearest wall"};
  }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3f normal;
      const float distance = boundary_.distance(points[i].xyz(), normal);
      const Weight weight = table_(distance * inverseSupport_);
      out[i] = {1 - weight.value, distance, -weight.slope * normal, -weight.pairSlope * normal};
    }
  }

 private:
  const Boundary& boundary_;
  float inverseSupport_;
  WeightTable table_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeWallWeight(const GammaContext& context) {
  const double ratio = static_cast<double>(context.supportRadius) / static_cast<double>(context.spacing);
  const auto massRatio = static_cast<double>(restingLattice(context.kernel, ratio).massRatio);
  return withKernel(context.kernel, [&](auto kernel) -> std::unique_ptr<GammaMethod> {
    return std::make_unique<WallWeight>(context, WeightTable::of<decltype(kernel)>(1 / ratio, massRatio));
  });
}

}  // namespace migiwa
