// A particle and several of its neighbours at a time: loads of a float4 each and a transpose, in place of
// gathers. Compiled once for every instruction set: include after
// <hwy/highway.h>.
#if defined(MIGIWA_PAIRS_SIMD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef MIGIWA_PAIRS_SIMD_INL_H
#undef MIGIWA_PAIRS_SIMD_INL_H
#else
#define MIGIWA_PAIRS_SIMD_INL_H
#endif

#include <algorithm>
#include <cmath>

#include <hwy/highway.h>

#include "core/solver/parameters.h"
#include "core/solver/state.h"
#include "core/sph/kernels_simd-inl.h"

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

/// The float4 at an offset in bytes, `kEach` float4 being a particle's.
template <std::size_t kEach>
HWY_INLINE const float* atOffset(const Float4* base, std::uint32_t offset) {
  return reinterpret_cast<const float*>(reinterpret_cast<const char*>(base) + kEach * offset);
}

#if HWY_TARGET == HWY_SCALAR
template <std::size_t kEach = 1>
HWY_INLINE Components loadComponents(const Float4* base, const std::uint32_t* HWY_RESTRICT offsets) {
  const Pairs d;
  const float* const at = atOffset<kEach>(base, *offsets);
  return {hn::Set(d, at[0]), hn::Set(d, at[1]), hn::Set(d, at[2]), hn::Set(d, at[3])};
}
#else
/// The k-th float4, and the one four further on where a vector holds eight floats.
template <std::size_t kEach>
HWY_INLINE PairVector loadBlocks(const Float4* base, const std::uint32_t* HWY_RESTRICT offsets,
                                 std::size_t k) {
  const hn::Full128<float> quad;
#if HWY_MAX_BYTES == 16
  return hn::Load(quad, atOffset<kEach>(base, offsets[k]));
#else
  return hn::Combine(Pairs(), hn::Load(quad, atOffset<kEach>(base, offsets[k + 4])),
                     hn::Load(quad, atOffset<kEach>(base, offsets[k])));
#endif
}

/// Loads the float4 at the offsets from `base`, where `kEach` of them are a particle's: the first of these.
template <std::size_t kEach = 1>
HWY_INLINE Components loadComponents(const Float4* base, const std::uint32_t* HWY_RESTRICT offsets) {
  const Pairs d;
  const PairVector a = loadBlocks<kEach>(base, offsets, 0), b = loadBlocks<kEach>(base, offsets, 1);
  const PairVector c = loadBlocks<kEach>(base, offsets, 2), e = loadBlocks<kEach>(base, offsets, 3);
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
  bool guards;

  explicit PairScale(const StepState& state)
      : support(state.supportRadius),
        inverseSupport(1 / support),
        inverseSquare(inverseSupport * inverseSupport),
        ids(state.particles.id.data()),
        metCoincident(state.metCoincident),
        guards(state.guards) {}
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

/// What a first loop over some of a particle's neighbours leaves to a second: more sums than there are
/// registers for go through memory with every pair.
struct PairBlock {
  static constexpr std::size_t kMost = 16 * NeighbourLists::kGroup;
  alignas(32) float x[kMost], y[kMost], z[kMost];  ///< gradients of the kernel, without its constants (m)

  HWY_INLINE void store(std::size_t k, PairVector ax, PairVector ay, PairVector az) {
    const Pairs d;
    hn::Store(ax, d, &x[k]), hn::Store(ay, d, &y[k]), hn::Store(az, d, &z[k]);
  }
};

/// Whether one of the pairs is on one point, where they need a direction: then all of a sum's components were
/// divided by zero, and one stands for all. Where no sum divides by the distance, such a pair adds nothing,
/// and needs none.
HWY_INLINE bool hasCoincident(const Float4& sums) {
  return !std::isfinite(sums.x);
}

/// Whether a particle's pairs have met one on one point. A push that is singular there tells by its sum, so
/// that no pair needs to be asked; of others the shortest distance is kept.
template <class Pair>
class Coincidence {
 public:
  HWY_INLINE Coincidence() { least_ = hn::Set(Pairs(), 1.0F); }
  HWY_INLINE void meet(PairVector q2) {
    if constexpr (!Pair::kSingular) least_ = hn::Min(least_, q2);
  }
  HWY_INLINE bool met(const Float4& sums) const {
    if constexpr (Pair::kSingular) return hasCoincident(sums);
    return !hn::AllFalse(Pairs(), hn::Eq(least_, hn::Zero(Pairs())));
  }

 private:
  PairVector least_;
};

/// use(i, sum(centre, i)) for the particles from `begin` to `end`, `positions` theirs. Those with a pair on
/// one point have their turn at the end.
template <class Sum, class Use>
HWY_INLINE void forPairs(const Float4* positions, const PairScale& scale, std::size_t begin, std::size_t end,
                         const Sum& sum, const Use& use) {
  std::size_t first = end;
  for (std::size_t i = begin; i < end; ++i) {
    const auto sums = sum(PairCentre(positions[i], scale), i);
    if (HWY_UNLIKELY(hasCoincident(sums)) && scale.guards) {
      first = HWY_MIN(first, i);
      continue;
    }
    use(i, sums);
  }
  for (std::size_t i = first; i < end; ++i) {
    const PairCentre centre(positions[i], scale);
    if (hasCoincident(sum(centre, i))) use(i, sum(PartingCentre{centre, scale, i}, i));
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

/// The sums over the lanes of four vectors, as one float4; in one order, as sumLanes of one vector.
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

/// What the pairs of a particle add up to.
struct PairSums {
  Float4 four;
  float fifth;
  bool coincident;  ///< whether a neighbour is on the particle's own point
};

/// Sums anew for those of `count` particles that have a pair on one point.
template <class Sum>
HWY_NOINLINE void partCoincident(const Float4* positions, const PairScale& scale, std::size_t first,
                                 std::size_t count, const Sum& sum, Float4* four, float* fifth) {
  for (std::size_t k = 0; k < count; ++k) {
    const PairCentre centre(positions[first + k], scale);
    if (!sum(centre, first + k).coincident) continue;
    const PairSums parted = sum(PartingCentre{centre, scale, first + k}, first + k);
    four[k] = parted.four, fifth[k] = parted.fifth;
  }
}

/// As forPairs, for PairSums, with as many particles at a time as a vector has lanes:
/// finish(first, count, four, fifth), both arrays of kPairs.
template <class Sum, class Finish>
HWY_INLINE void forBlocks(const Float4* positions, const PairScale& scale, std::size_t begin, std::size_t end,
                          const Sum& sum, const Finish& finish) {
  alignas(32) Float4 four[kPairs] = {};
  alignas(32) float fifth[kPairs] = {};
  for (std::size_t first = begin; first < end; first += kPairs) {
    const std::size_t count = HWY_MIN(kPairs, end - first);
    bool coincident = false;
    for (std::size_t k = 0; k < count; ++k) {
      const PairSums sums = sum(PairCentre(positions[first + k], scale), first + k);
      four[k] = sums.four, fifth[k] = sums.fifth;
      coincident = coincident || sums.coincident;
    }
    if (HWY_UNLIKELY(coincident) && scale.guards)
      partCoincident(positions, scale, first, count, sum, four, fifth);
    finish(first, count, four, fifth);
  }
}

/// rho/rho0 of a particle by its `sum` over neighbours and itself; `resting`: StepState::densityGamma().
HWY_INLINE float correctedDensity(float sum, float resting, bool addsWall) {
  return addsWall ? sum + 1 - resting : sum / resting;
}

/// use(kernel) for the kernels whose own gradient moves particles.
template <class Use>
HWY_INLINE void withOwnGradient(KernelType kernel, const Use& use) {
  if (kernel == KernelType::cubicSpline) return use(CubicSpline{});
  use(WendlandC2{});
}

/// Three components of a vector quantity, a particle a lane.
struct Vectors {
  PairVector x, y, z;
};

/// of(i) for those of `count` particles from `first` on that are near a wall, zero for the others.
template <class OfParticle>
HWY_INLINE Vectors gatherAtWalls(const std::uint32_t* wallSlot, std::size_t first, std::size_t count,
                                 const OfParticle& of) {
  const Pairs d;
  bool any = false;
  for (std::size_t k = 0; k < count; ++k) any |= wallSlot[first + k] != FluidState::kNoWall;
  if (!any) return {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  alignas(32) float x[kPairs] = {}, y[kPairs] = {}, z[kPairs] = {};
  for (std::size_t k = 0; k < count; ++k) {
    if (wallSlot[first + k] == FluidState::kNoWall) continue;
    const Vec3f at = of(first + k);
    x[k] = at.x(), y[k] = at.y(), z[k] = at.z();
  }
  return {hn::Load(d, x), hn::Load(d, y), hn::Load(d, z)};
}

/// A whole vector of an array, or the `count` that are left of it and zeros.
HWY_INLINE PairVector loadSome(const float* from, std::size_t count) {
  const Pairs d;
  if (HWY_LIKELY(count == kPairs)) return hn::LoadU(d, from);
  alignas(32) float some[kPairs] = {};
  std::copy_n(from, count, some);
  return hn::Load(d, some);
}
HWY_INLINE void storeSome(PairVector v, float* to, std::size_t count) {
  const Pairs d;
  if (HWY_LIKELY(count == kPairs)) return hn::StoreU(v, d, to);
  alignas(32) float some[kPairs];
  hn::Store(v, d, some);
  std::copy_n(some, count, to);
}
HWY_INLINE Components loadSome(const Float4* from, std::size_t count) {
  const Pairs d;
  Components c;
  if (HWY_LIKELY(count == kPairs)) {
    hn::LoadInterleaved4(d, &from->x, c.x, c.y, c.z, c.w);
    return c;
  }
  alignas(32) Float4 some[kPairs] = {};
  std::copy_n(from, count, some);
  hn::LoadInterleaved4(d, &some->x, c.x, c.y, c.z, c.w);
  return c;
}
HWY_INLINE void storeSome(const Components& c, Float4* to, std::size_t count) {
  const Pairs d;
  if (HWY_LIKELY(count == kPairs)) return hn::StoreInterleaved4(c.x, c.y, c.z, c.w, d, &to->x);
  alignas(32) Float4 some[kPairs];
  hn::StoreInterleaved4(c.x, c.y, c.z, c.w, d, &some->x);
  std::copy_n(some, count, to);
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // MIGIWA_PAIRS_SIMD_INL_H
