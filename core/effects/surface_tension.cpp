// Surface tension (Akinci, Akinci & Teschner 2013): pairs attract each other, or push when they are close
// (cohesion), and particles move to even out the normals of the surface (area):
//   a_i = -sigma/(rho0 h^2) sum_j 2/(rho_i + rho_j) [ c m/(rho0 h^3) C(q) e + a (n_i - n_j) ],
//   n_i = h sum_j (m/rho0) grad W_ij, rho over rho0, e from j to i, C as in the paper, scaled to C(1/2) = 1.
// Both parts are antisymmetric, so momentum is conserved. Deviations: the factors c and a are measured, so
// that sigma is the surface tension of the continuum, by the period of a droplet's oscillation; and the rest
// density in n_i. A wall attracts nothing: to the fluid it is air that cannot be entered.
#include <cmath>
#include <numbers>

#include "core/effects/effects.h"
#include "core/solver/state.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/surface_tension.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pairs_simd-inl.h"

#ifndef MIGIWA_SURFACE_TENSION_TYPES
#define MIGIWA_SURFACE_TENSION_TYPES
namespace migiwa {

/// What the two parts are multiplied by (m).
struct TensionScale {
  float cohesion, area;
};

}  // namespace migiwa
#endif

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// n_i (xyz) and rho_i/rho0 (w).
template <class Kernel>
void normalsRange(StepState& state, std::size_t begin, std::size_t end) {
  using Density = KernelVectors<Kernel>;
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const PairScale pairScale(state);
  const Float4* const positions = state.current.data();
  const auto sumOf = [&](const auto& centre, std::size_t i) HWY_ATTR {
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const Pairs d;
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d), covered = hn::Zero(d);
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const Distances<PairVector> r = distances(d, pair.squared);
      covered = hn::Add(covered, Density::shape(d, r));
      const PairVector push = Pair::push(d, r);
      x = hn::MulAdd(push, pair.x, x), y = hn::MulAdd(push, pair.y, y), z = hn::MulAdd(push, pair.z, z);
    }
    return sumLanes(x, y, z, covered);
  };
  const auto use = [&](std::size_t i, const Float4& sums) HWY_ATTR {
    const float mass = state.lattice.massRatio;
    state.paired[i] = Float4(Vec3f(mass * Pair::kSlope * pairScale.inverseSupport * sums.xyz()),
                             mass * (Kernel::value(0) + Density::kValue * sums.w));
  };
  forPairs(positions, pairScale, begin, end, sumOf, use);
}

void normalsOfRange(StepState& state, std::size_t begin, std::size_t end) {
  withKernel(state.parameters.kernel,
             [&](auto kernel) HWY_ATTR { normalsRange<decltype(kernel)>(state, begin, end); });
}

/// Moved positions from state.current and state.paired into state.previous.
void pullOfRange(StepState& state, const TensionScale& scale, std::size_t begin, std::size_t end) {
  const PairScale pairScale(state);
  const Float4* const positions = state.current.data();
  const Float4* const normals = state.paired.data();
  const auto sumOf = [&](const auto& centre, std::size_t i) HWY_ATTR {
    const Float4 own = normals[i];
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const Pairs d;
    const PairVector one = hn::Set(d, 1.0F), two = hn::Set(d, 2.0F), half = hn::Set(d, 0.5F);
    const PairVector cohesion = hn::Set(d, -scale.cohesion * pairScale.inverseSupport);
    const PairVector area = hn::Set(d, -scale.area);
    const PairVector nx = hn::Set(d, own.x), ny = hn::Set(d, own.y), nz = hn::Set(d, own.z),
                     density = hn::Set(d, own.w);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const Distances<PairVector> r = distances(d, pair.squared);
      const Components others = loadComponents(normals, &list[k]);
      // C(q), 64 times the paper's: (1 - q)^3 q^3, and twice that less 1/64 below q = 1/2.
      const PairVector t = hn::Mul(hn::Sub(one, r.q), r.q), cube = hn::Mul(hn::Mul(t, t), t);
      const PairVector far = hn::Mul(hn::Set(d, 64.0F), cube), near = hn::Sub(hn::Add(far, far), one);
      const PairVector attraction =
          hn::Mul(cohesion, hn::Div(hn::IfThenElse(hn::Lt(r.q, half), near, far), r.q));
      // Of pairs in reach only: the lists are filled up with others.
      const PairVector inReach =
          hn::IfThenElseZero(hn::Lt(r.q2, one), hn::Div(two, hn::Add(density, others.w)));
      const PairVector pull = hn::Mul(inReach, attraction), even = hn::Mul(inReach, area);
      x = hn::MulAdd(pull, pair.x, hn::MulAdd(even, hn::Sub(nx, others.x), x));
      y = hn::MulAdd(pull, pair.y, hn::MulAdd(even, hn::Sub(ny, others.y), y));
      z = hn::MulAdd(pull, pair.z, hn::MulAdd(even, hn::Sub(nz, others.z), z));
    }
    return sumLanes(x, y, z, hn::Zero(d));
  };
  const auto use = [&](std::size_t i, const Float4& sums)
                       HWY_ATTR { state.previous[i] = Float4(Vec3f(positions[i].xyz() + sums.xyz())); };
  forPairs(positions, pairScale, begin, end, sumOf, use);
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(normalsOfRange);
HWY_EXPORT(pullOfRange);

namespace {

/// The factors c and a of the two parts. Their ratio makes cohesion the larger part, as in the paper; their
/// size makes the droplets of tests/effects/surface_tension_test.cpp swing with the period of Rayleigh 1879.
constexpr float kCohesion = 3.2F, kArea = 0.4F;

class SurfaceTension final : public EffectOf<SurfaceTension> {
 public:
  static void fields(auto& visitor, auto& self) {
    visitor.number("coefficient", self.coefficient_, Range::closed(0, 1e6),
                   {"N/m", "Surface tension of the liquid against air; water has 0.072."});
  }

  EffectStages stages() const override { return {.prediction = coefficient_ > 0}; }

  /// Brackbill, Kothe & Zemach 1992: a capillary wave as short as particles resolve must not run ahead.
  double longestStep(const StepState& state) const override {
    const auto spacing = static_cast<double>(state.spacing);
    return 0.25 * std::sqrt(state.parameters.restDensity * spacing * spacing * spacing /
                            (2 * std::numbers::pi * coefficient_));
  }

  void changePrediction(StepState& state, std::span<EffectBuffer>) const override {
    const std::size_t n = state.particles.size();
    resizeTight(state.paired, n + 1);
    resizeTight(state.previous, n + 1);
    state.paired[n] = Float4(0, 0, 0, 1);
    state.previous[n] = state.current[n];
    const auto normals = HWY_DYNAMIC_DISPATCH(normalsOfRange);
    parallelFor(state.pool, n,
                [&](std::size_t begin, std::size_t end, std::size_t) { normals(state, begin, end); });
    const double length = static_cast<double>(state.supportRadius);
    const double acceleration = coefficient_ / (state.parameters.restDensity * length * length);
    const auto move = static_cast<float>(acceleration) * state.timeStep * state.timeStep;
    const TensionScale scale{move * kCohesion * state.lattice.massRatio, move * kArea};
    const auto pull = HWY_DYNAMIC_DISPATCH(pullOfRange);
    parallelFor(state.pool, n,
                [&](std::size_t begin, std::size_t end, std::size_t) { pull(state, scale, begin, end); });
    state.current.swap(state.previous);
  }

 private:
  double coefficient_ = 0.072;
};

}  // namespace

std::unique_ptr<Effect> makeSurfaceTension() {
  return std::make_unique<SurfaceTension>();
}

}  // namespace migiwa
#endif  // HWY_ONCE
