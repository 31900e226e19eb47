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

/// Sum over the neighbours of (w_i + w_j) times the push of the pair kernel, without its constant.
template <class Kernel, class Centre>
HWY_INLINE PairSums pushOfPairs(const StepState& state, const Centre& centre, std::size_t i) {
  using Pair = KernelVectors<PairKernel<Kernel>>;
  const Pairs d;
  const Float4* const others = state.paired.data();
  const PairVector own = hn::Set(d, others[i].w);
  PairVector x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
  Coincidence<Pair> coincidence;
  const std::span<const std::uint32_t> list = state.neighbours.groups(i);
  prefetchLists(list.data());
  for (std::size_t k = 0; k < list.size(); k += kPairs) {
    const Components neighbours = loadComponents(others, &list[k]);
    const PairOffsets pair = centre.to(neighbours, &list[k]);
    const Distances<PairVector> r = distances(d, pair.squared);
    const PairVector push = hn::Mul(hn::Add(own, neighbours.w), Pair::push(d, r));
    x = hn::MulAdd(push, pair.x, x), y = hn::MulAdd(push, pair.y, y), z = hn::MulAdd(push, pair.z, z);
    coincidence.meet(r.q2);
  }
  const Float4 sums = sumLanes(x, y, z, hn::Zero(d));
  return {sums, 0, coincidence.met(sums)};
}

template <class Kernel>
void moveRange(StepState& state, float weight, std::size_t begin, std::size_t end) {
  const Pairs d;
  const bool wallPush = state.parameters.positionStep != PositionStep::paper;
  const PairScale scale(state);
  const float toWay =
      state.lattice.massRatio * scale.inverseSupport * KernelVectors<PairKernel<Kernel>>::kSlope;
  const PairVector pairScale = hn::Set(d, state.supportRadius * toWay),
                   support = hn::Set(d, state.supportRadius);
  const auto push = [&state](const auto& centre, std::size_t i)
                        HWY_ATTR { return pushOfPairs<Kernel>(state, centre, i); };
  const auto move = [&](std::size_t first, std::size_t count, const Float4* four,
                        const float* /*fifth*/) HWY_ATTR {
    const Components sums = loadSome(four, kPairs);
    Components at = loadSome(&state.current[first], count);
    at.x = hn::MulAdd(pairScale, sums.x, at.x);
    at.y = hn::MulAdd(pairScale, sums.y, at.y);
    at.z = hn::MulAdd(pairScale, sums.z, at.z);
    if (wallPush) {
      const Vectors wall = gatherAtWalls(state.wallSlot.data(), first, count, [&state](std::size_t i) {
        return Vec3f(state.wallPush(i) * state.wallSlots[state.wallSlot[i]].sample.pairGradient);
      });
      at.x = hn::NegMulAdd(support, wall.x, at.x);
      at.y = hn::NegMulAdd(support, wall.y, at.y);
      at.z = hn::NegMulAdd(support, wall.z, at.z);
    }
    if (weight != 1) {
      const Components before = loadSome(&state.previous[first], count);
      const PairVector share = hn::Set(d, weight);
      at.x = hn::MulAdd(share, hn::Sub(at.x, before.x), before.x);
      at.y = hn::MulAdd(share, hn::Sub(at.y, before.y), before.y);
      at.z = hn::MulAdd(share, hn::Sub(at.z, before.z), before.z);
    }
    at.w = hn::Zero(d);
    storeSome(at, &state.previous[first], count);
  };
  forBlocks(state.paired.data(), scale, begin, end, push, move);
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
