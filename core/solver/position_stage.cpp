// METHOD: the displacement of [FM] Eq. 10 in three forms, see PositionStep.
// Deviation: the default is the constraint's true gradient step,
//   dx_i = (m/rho0) sum_j (lambda_i/gamma_i + lambda_j/gamma_j) grad W_ij - lambda_i rho_i/(rho0 gamma_i)
//   grad gamma_i,
// whose last term is the wall pushing back; Eq. 10 as printed lets particles crowd the wall.
#include "core/solver/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/position_stage.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pair_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// Sum over the neighbours of (w_i + w_j) times the gradient of the pair kernel, times the support radius
/// squared.
template <class Kernel, class Centre>
HWY_INLINE Float4 pushOfPairs(const StepState& state, const Centre& centre, std::size_t i) {
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const Pairs d;
  const Float4* const others = state.paired.data();
  const PairVector own = hn::Set(d, others[i].w);
  PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
  const std::span<const std::uint32_t> list = state.neighbours.groups(i);
  prefetchLists(list.data());
  for (std::size_t k = 0; k < list.size(); k += kPairs) {
    const Components neighbours = loadComponents(others, &list[k]);
    const PairOffsets pair = centre.to(neighbours, &list[k]);
    const Distances<PairVector> r = distances(d, pair.squared);
    const PairVector push = hn::Mul(hn::Add(own, neighbours.w), Pair::slopeOverDistance(d, r));
    x = hn::MulAdd(push, pair.x, x), y = hn::MulAdd(push, pair.y, y), z = hn::MulAdd(push, pair.z, z);
  }
  return sumLanes(x, y, z, hn::Zero(d));
}

template <class Kernel>
void moveRange(StepState& state, float weight, std::size_t begin, std::size_t end) {
  const bool wallPush = state.parameters.positionStep != PositionStep::paper;
  const PairScale scale(state);
  const auto push = [&state](const auto& centre, std::size_t i)
                        HWY_ATTR { return pushOfPairs<Kernel>(state, centre, i); };
  const auto move = [&](std::size_t i, const Float4& sums) HWY_ATTR {
    Vec3f way = state.lattice.massRatio * (scale.inverseSupport * sums.xyz());
    if (const std::uint32_t slot = state.wallSlot[i]; wallPush && slot != StepState::kNoWall)
      way -= state.wallPush(i) * state.wallSlots[slot].sample.pairGradient;
    Vec3f moved = state.current[i].xyz() + state.supportRadius * way;
    if (weight != 1) {
      const Vec3f before = state.previous[i].xyz();
      moved = before + weight * (moved - before);
    }
    state.previous[i] = Float4(moved);
  };
  forPairs(state.paired.data(), scale, begin, end, push, move);
}

void movePositionsOfRange(StepState& state, float weight, std::size_t begin, std::size_t end) {
  withKernel(state.parameters.kernel,
             [&](auto kernel) HWY_ATTR { moveRange<decltype(kernel)>(state, weight, begin, end); });
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(movePositionsOfRange);

void stages::movePositions(StepState& state, float weight) {
  const std::size_t n = state.particles.size();
  resizeTight(state.previous, n + 1);
  state.previous[n] = state.current[n];
  const auto ofRange = HWY_DYNAMIC_DISPATCH(movePositionsOfRange);
  parallelFor(state.pool, n,
              [&](std::size_t begin, std::size_t end, std::size_t) { ofRange(state, weight, begin, end); });
  state.current.swap(state.previous);
}

}  // namespace migiwa
#endif  // HWY_ONCE
