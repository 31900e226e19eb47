// A particle and several of its neighbours at a time: loads of a float4 each and a transpose, in place of
// gathers. Compiled once for every instruction set: include after
// <hwy/highway.h>.
#if defined(MIGIWA_PAIR_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef MIGIWA_PAIR_VECTORS_INL_H
#undef MIGIWA_PAIR_VECTORS_INL_H
#else
#define MIGIWA_PAIR_VECTORS_INL_H
#endif

#include <cmath>

#include <hwy/highway.h>

#include "core/base/guard.h"
#include "core/solver/coincident_pair.h"
#include "core/solver/step_state.h"
#include "core/sph/kernel_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Neighbours that fit a vector: a whole group, a half of it where vectors are short, or one.
using Pairs = hn::CappedTag<float, NeighbourLists::kGroup>;
using PairVector = hn::Vec<Pairs>;
/// Never more than a group, whatever the processor.
inline constexpr std::size_t kPairs = hn::MaxLanes(Pairs());

/// The components of kPairs float4.
struct Components {
  PairVector x, y, z, w;
};

/// The float4 at an offset in bytes.
HWY_INLINE const float* atOffset(const Float4* base, std::uint32_t offset) {
  return reinterpret_cast<const float*>(reinterpret_cast<const char*>(base) + offset);
}

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Components loadComponents(const Float4* base, const std::uint32_t* HWY_RESTRICT offsets) {
  const Pairs d;
  const float* const at = atOffset(base, *offsets);
  return {hn::Set(d, at[0]), hn::Set(d, at[1]), hn::Set(d, at[2]), hn::Set(d, at[3])};
}
#else
/// The k-th float4, and the one four further on where a vector holds eight floats.
HWY_INLINE PairVector loadBlocks(const Float4* base, const std::uint32_t* HWY_RESTRICT offsets,
                                 std::size_t k) {
  const hn::Full128<float> quad;
#if HWY_MAX_BYTES == 16
  return hn::Load(quad, atOffset(base, offsets[k]));
#else
  return hn::Combine(Pairs(), hn::Load(quad, atOffset(base, offsets[k + 4])),
                     hn::Load(quad, atOffset(base, offsets[k])));
#endif
}

/// Loads the float4 at the offsets from `base`.
HWY_INLINE Components loadComponents(const Float4* base, const std::uint32_t* HWY_RESTRICT offsets) {
  const Pairs d;
  const PairVector a = loadBlocks(base, offsets, 0), b = loadBlocks(base, offsets, 1);
  const PairVector c = loadBlocks(base, offsets, 2), e = loadBlocks(base, offsets, 3);
  const PairVector xy02 = hn::InterleaveLower(d, a, c), xy13 = hn::InterleaveLower(d, b, e);
  const PairVector zw02 = hn::InterleaveUpper(d, a, c), zw13 = hn::InterleaveUpper(d, b, e);
  return {hn::InterleaveLower(d, xy02, xy13), hn::InterleaveUpper(d, xy02, xy13),
          hn::InterleaveLower(d, zw02, zw13), hn::InterleaveUpper(d, zw02, zw13)};
}
#endif

/// Offsets from the neighbours to the particle (m), and their squared lengths over the support radius.
struct PairOffsets {
  PairVector x, y, z, squared;
};

/// What all pairs have in common.
struct PairScale {
  float support, inverseSupport, inverseSquare;
  const std::uint32_t* ids;
  std::atomic<bool>& metCoincident;

  explicit PairScale(const StepState& state)
      : support(state.supportRadius),
        inverseSupport(1 / support),
        inverseSquare(inverseSupport * inverseSupport),
        ids(state.particles.id.data()),
        metCoincident(state.metCoincident) {}
};

/// A particle at `at`, to be paired with its neighbours.
struct PairCentre {
  PairVector x, y, z, inverseSquare;

  HWY_INLINE PairCentre(const Float4& at, const PairScale& scale)
      : x(hn::Set(Pairs(), at.x)),
        y(hn::Set(Pairs(), at.y)),
        z(hn::Set(Pairs(), at.z)),
        inverseSquare(hn::Set(Pairs(), scale.inverseSquare)) {}

  HWY_INLINE PairOffsets to(const Components& others, const std::uint32_t* /*offsets*/) const {
    PairOffsets pair{hn::Sub(x, others.x), hn::Sub(y, others.y), hn::Sub(z, others.z), hn::Zero(Pairs())};
    pair.squared = hn::Mul(inverseSquare,
                           hn::MulAdd(pair.x, pair.x, hn::MulAdd(pair.y, pair.y, hn::Mul(pair.z, pair.z))));
    return pair;
  }
};

/// A particle that is on one point with others: those pairs get the shortest distance that has a direction,
/// and that of their ids.
struct PartingCentre {
  PairCentre centre;
  const PairScale& scale;
  std::size_t own;

  HWY_NOINLINE PairOffsets to(const Components& others, const std::uint32_t* offsets) const {
    // A squared distance over the support radius whose inverse does not overflow.
    constexpr float kLeast = 1e-36F;
    const Pairs d;
    const PairOffsets pair = centre.to(others, offsets);
    float lanes[4][kPairs];
    hn::StoreU(pair.x, d, lanes[0]), hn::StoreU(pair.y, d, lanes[1]), hn::StoreU(pair.z, d, lanes[2]);
    hn::StoreU(pair.squared, d, lanes[3]);
    for (std::size_t k = 0; k < kPairs; ++k) {
      if (!(lanes[3][k] < kLeast)) continue;
      scale.metCoincident.store(true, std::memory_order_relaxed);
      const Vec3f direction = coincidentDirection(scale.ids[own], scale.ids[offsets[k] / sizeof(Float4)]);
      for (int axis = 0; axis < 3; ++axis) lanes[axis][k] = kCoincident * scale.support * direction[axis];
      lanes[3][k] = kCoincident * kCoincident;
    }
    return {hn::LoadU(d, lanes[0]), hn::LoadU(d, lanes[1]), hn::LoadU(d, lanes[2]), hn::LoadU(d, lanes[3])};
  }
};

/// Where pairs need a direction, all of a sum's components have the inverse distance for a factor: one stands
/// for all.
HWY_INLINE bool isFinite(const Float4& sums) {
  return std::isfinite(sums.x);
}

/// use(i, sum(centre, i)) for the particles from `begin` to `end`, `positions` theirs. The inverse distance
/// of a pair on one point is infinite, and with it the sum is not finite: no pair needs to be asked, and
/// those particles have their turn at the end.
template <class Sum, class Use>
HWY_INLINE void forPairs(const Float4* positions, const PairScale& scale, std::size_t begin, std::size_t end,
                         const Sum& sum, const Use& use) {
  std::size_t first = end;
  for (std::size_t i = begin; i < end; ++i) {
    const auto sums = sum(PairCentre(positions[i], scale), i);
    if (kGuards && HWY_UNLIKELY(!isFinite(sums))) {
      first = HWY_MIN(first, i);
      continue;
    }
    use(i, sums);
  }
  for (std::size_t i = first; i < end; ++i) {
    const PairCentre centre(positions[i], scale);
    if (!isFinite(sum(centre, i))) use(i, sum(PartingCentre{centre, scale, i}, i));
  }
}

/// Asks early for the lists of the particles to come. From 100,000 particles on they are a stream that no
/// cache holds, and the processor loses it among the rows of neighbours: a twentieth of a pass. The address
/// is reckoned in bytes, for it may lie beyond the lists, where a pointer may not.
HWY_INLINE void prefetchLists(const std::uint32_t* list) {
  constexpr std::uintptr_t kAhead = 640, kCacheLine = 64;
  const std::uintptr_t ahead = reinterpret_cast<std::uintptr_t>(list) + kAhead;
  __builtin_prefetch(reinterpret_cast<const void*>(ahead));               // NOLINT: nothing is read
  __builtin_prefetch(reinterpret_cast<const void*>(ahead + kCacheLine));  // NOLINT
}

/// The sums over the lanes of four vectors, as one float4.
HWY_INLINE Float4 sumLanes(PairVector a, PairVector b, PairVector c, PairVector e) {
#if HWY_TARGET == HWY_SCALAR
  return {hn::GetLane(a), hn::GetLane(b), hn::GetLane(c), hn::GetLane(e)};
#else
  const Pairs d;
  const hn::Full128<float> quad;
  const PairVector ab = hn::Add(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b));
  const PairVector ce = hn::Add(hn::InterleaveLower(d, c, e), hn::InterleaveUpper(d, c, e));
#if HWY_MAX_BYTES == 16
  const auto ab4 = ab, ce4 = ce;
#else
  const auto ab4 = hn::Add(hn::LowerHalf(quad, ab), hn::UpperHalf(quad, ab));
  const auto ce4 = hn::Add(hn::LowerHalf(quad, ce), hn::UpperHalf(quad, ce));
#endif
  Float4 sums;
  hn::Store(hn::Add(hn::ConcatLowerLower(quad, ce4, ab4), hn::ConcatUpperUpper(quad, ce4, ab4)), quad,
            &sums.x);
  return sums;
#endif
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // MIGIWA_PAIR_VECTORS_INL_H
