// Artificial pressure (Macklin & Mueller 2013, Eq. 13; Monaghan 2000): pairs that are close push each other
// away with s_corr = -k (W(q) / W(delta_q))^n beside lambda_i + lambda_j, which keeps particles evenly spread
// where the density alone does not, at free surfaces above all. A pass of its own beside the position step's.
// Deviations: with a solver that has no constraint it is the acceleration that PBF would give in steps as
// long as the scene asks for, whatever the steps that the solver takes; k is a compression, so that its
// strength depends neither on the spacing nor on the kernel.
#include "core/effects/effects.h"
#include "core/solver/state.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/artificial_pressure.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pairs_simd-inl.h"

#ifndef MIGIWA_ARTIFICIAL_PRESSURE_TYPES
#define MIGIWA_ARTIFICIAL_PRESSURE_TYPES
namespace migiwa {

/// The push of a pair: scale * (W / reference)^power.
struct PairPush {
  float scale, reference;
  int power;
};

}  // namespace migiwa
#endif

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

template <class Kernel>
void partRange(StepState& state, const PairPush& push, std::size_t begin, std::size_t end) {
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const PairScale pairScale(state);
  const float scale = push.scale * Pair::kSlope;
  const Float4* const positions = state.paired.data();
  const auto sumOf = [&](const auto& centre, std::size_t i) HWY_ATTR {
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    const Pairs d;
    const PairVector inverseReference = hn::Set(d, KernelVectors<Kernel>::kValue / push.reference);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const Distances<PairVector> r = distances(d, pair.squared);
      const PairVector ratio = hn::Mul(KernelVectors<Kernel>::shape(d, r), inverseReference);
      PairVector force = Pair::push(d, r);
      for (int p = 0; p < push.power; ++p) force = hn::Mul(force, ratio);
      x = hn::MulAdd(force, pair.x, x), y = hn::MulAdd(force, pair.y, y), z = hn::MulAdd(force, pair.z, z);
    }
    return sumLanes(x, y, z, hn::Zero(d));
  };
  const auto use = [&](std::size_t i, const Float4& sums) HWY_ATTR {
    state.current[i] = Float4(Vec3f(state.current[i].xyz() + scale * sums.xyz()));
  };
  forPairs(positions, pairScale, begin, end, sumOf, use);
}

void partPairsOfRange(StepState& state, const PairPush& push, std::size_t begin, std::size_t end) {
  withKernel(state.parameters.kernel,
             [&](auto kernel) HWY_ATTR { partRange<decltype(kernel)>(state, push, begin, end); });
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(partPairsOfRange);

namespace {

class ArtificialPressure final : public EffectOf<ArtificialPressure> {
 public:
  static void fields(auto& visitor, auto& self) {
    visitor.number("k", self.k_, Range::closed(0, 1),
                   {"1", "Strength: the compression (rho/rho0 - 1) that pushes like a pair at delta_q."});
    visitor.integer("n", self.n_, Range::closed(1, 8), {"1", "Power with which the push falls off."});
    visitor.number("delta_q", self.deltaQ_, Range::halfOpen(0, 1),
                   {"1", "Distance at which a pair pushes with strength k, over the support radius."});
  }

  EffectStages stages() const override { return {.iteration = k_ > 0}; }

  void changePositions(StepState& state, float weight) const override {
    PairPush push{};
    // lambda of a particle that is compressed by k and has its neighbours about it.
    const double lambda =
        -k_ / ((1 + state.parameters.cfmEpsilon) * static_cast<double>(state.lattice.squaredGradients));
    push.scale = weight * state.lattice.massRatio * static_cast<float>(lambda);
    if (!state.constrains()) {
      const double asked = state.parameters.timeStep / state.parameters.substeps;
      const float part = state.timeStep / static_cast<float>(asked);
      push.scale *= part * part;
    }
    push.reference = withKernel(state.parameters.kernel, [&](auto kernel) {
      return decltype(kernel)::value(static_cast<float>(deltaQ_));
    });
    push.power = n_;
    const auto ofRange = HWY_DYNAMIC_DISPATCH(partPairsOfRange);
    parallelFor(state.pool, state.particles.size(),
                [&](std::size_t begin, std::size_t end, std::size_t) { ofRange(state, push, begin, end); });
  }

 private:
  double k_ = 0.1;
  int n_ = 4;
  double deltaQ_ = 0.2;
};

}  // namespace

std::unique_ptr<Effect> makeArtificialPressure() {
  return std::make_unique<ArtificialPressure>();
}

}  // namespace migiwa
#endif  // HWY_ONCE
