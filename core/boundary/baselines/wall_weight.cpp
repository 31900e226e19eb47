// Harada, Koshizuka, Kawaguchi 2007, "Smoothed Particle Hydrodynamics in Complex Shapes" (SCCG; also
// "Improvement of the Boundary Conditions in Smoothed Particle Hydrodynamics", CGG 2007): the wall is thought
// of as full of particles at rest, and what they add to the density, the wall weight function Z(d), is summed
// once for a table over the distance: rho_i = S_i + Z(d_i). The wall particles lie on the lattice of the
// fluid at rest, its first layer half a spacing behind the wall and one of its axes through the fluid
// particle: a lattice that rests on a flat wall goes on in it, and reads the density at rest.
// Deviation: the paper pushes particles out by their depth in the wall; here the gradient of Z pushes, so
// that all handlings meet in the same solver. Where several walls are near, the nearest alone counts.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/boundary/baselines/baselines.h"
#include "core/sph/kernels.h"
#include "core/sph/resting_lattice.h"

namespace migiwa {

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
