// XSPH (Schechter & Bridson 2012, Macklin & Mueller 2013): each velocity moves towards the kernel-weighted
// mean of its neighbours', v_i += c sum_j (m/rho0) (v_j - v_i) W_ij. Deviation: the rest density in place of
// rho_j makes the pairs symmetric, so momentum is conserved exactly.
#include "core/effects/effects.h"
#include "core/solver/step_state.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/viscosity.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pair_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// `before`: the velocities, with the ghost's.
template <class Kernel>
void smoothRange(StepState& state, const Float4* before, float scale, std::size_t begin, std::size_t end) {
  const Pairs d;
  const PairScale pairScale(state);
  const Float4* const positions = state.current.data();
  for (std::size_t i = begin; i < end; ++i) {
    const auto own = static_cast<std::uint32_t>(i);
    const PairCentre centre(positions[i], pairScale, own);
    const Float4 velocity = before[i];
    const PairVector vx = hn::Set(d, velocity.x), vy = hn::Set(d, velocity.y), vz = hn::Set(d, velocity.z);
    PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    const std::span<const std::uint32_t> list = state.neighbours.groups(i);
    for (std::size_t k = 0; k < list.size(); k += kPairs) {
      const PairOffsets pair = centre.to(loadComponents(positions, &list[k]), &list[k]);
      const Distances<PairVector> r = distances(d, pair.squared);
      const Components others = loadComponents(before, &list[k]);
      const PairVector value = KernelVectors<Kernel>::value(d, r);
      x = hn::MulAdd(value, hn::Sub(others.x, vx), x);
      y = hn::MulAdd(value, hn::Sub(others.y, vy), y);
      z = hn::MulAdd(value, hn::Sub(others.z, vz), z);
    }
    const Vec3f change = scale * sumLanes(x, y, z, hn::Zero(d)).xyz();
    state.particles.velocity[i] = Float4(velocity.xyz() + change);
  }
}

void smoothVelocitiesOfRange(StepState& state, const Float4* before, float scale, std::size_t begin,
                             std::size_t end) {
  withKernel(state.parameters.kernel,
             [&](auto kernel) HWY_ATTR { smoothRange<decltype(kernel)>(state, before, scale, begin, end); });
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(smoothVelocitiesOfRange);

namespace {

class Viscosity final : public Effect {
 public:
  void describe(FieldVisitor& visitor) override {
    visitor.number("xsph", xsph_, Range::closed(0, 1),
                   {"1", "Part of the velocity difference to the neighbours that a step takes away."});
  }

  void apply(StepState& state) const override {
    const std::size_t n = state.particles.size();
    std::vector<Float4>& before = state.paired;
    resizeTight(before, n + 1);
    before[n] = Float4();
    parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      std::copy(&state.particles.velocity[begin], &state.particles.velocity[begin] + (end - begin),
                &before[begin]);
    });
    const float scale = static_cast<float>(xsph_) * state.lattice.massRatio;
    const auto ofRange = HWY_DYNAMIC_DISPATCH(smoothVelocitiesOfRange);
    parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
      ofRange(state, before.data(), scale, begin, end);
    });
  }

 private:
  double xsph_ = 0.05;
};

}  // namespace

std::unique_ptr<Effect> makeViscosity() {
  return std::make_unique<Viscosity>();
}

}  // namespace migiwa
#endif  // HWY_ONCE
