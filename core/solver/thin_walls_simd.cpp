// What lies behind a thin wall is no neighbour: several neighbours at a time against the planes that touch
// the walls nearest to a particle, and against the blocks behind these planes.
#include <algorithm>
#include <limits>

#include "core/solver/step.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/solver/thin_walls_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/solver/pairs_simd-inl.h"

#ifndef MIGIWA_NEAR_WALL
#define MIGIWA_NEAR_WALL
namespace migiwa::stages {

/// A wall near a particle, and the plane that touches it nearest to the particle: points in front of the
/// plane are not hidden by a convex wall.
struct NearWall {
  const Surface* wall;
  const UprightBlock* block;  ///< null for other walls
  Vec3f normal;
  float offset;
};

/// What is known of a neighbour.
enum Sight : std::uint8_t { kSeen, kHidden, kAskWalls };

}  // namespace migiwa::stages
#endif

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// Where the way from a point to several others passes through a block, as Surface::crosses() has it, to the
/// last bit.
HWY_INLINE hn::Mask<Pairs> passesThrough(const UprightBlock& block, const Vec3f& from, const Components& to) {
  const Pairs d;
  const PairVector zero = hn::Zero(d), infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  PairVector enter = hn::Neg(infinity), leave = infinity;
  const PairVector* const ends[] = {&to.x, &to.y, &to.z};
  for (int axis = 0; axis < 3; ++axis) {
    const PairVector center = hn::Set(d, block.center[axis]), half = hn::Set(d, block.half[axis]);
    const PairVector start = hn::Set(d, from[axis] - block.center[axis]);
    const PairVector way = hn::Sub(hn::Sub(*ends[axis], center), start);
    const PairVector side = hn::CopySign(half, way);
    const auto along = hn::Eq(way, zero);
    // Along the faces: between them, or never.
    const auto outside = hn::And(along, hn::Ge(hn::Abs(start), half));
    PairVector in = hn::Div(hn::Sub(hn::Neg(side), start), way), out = hn::Div(hn::Sub(side, start), way);
    in = hn::IfThenElse(along, hn::IfThenElse(outside, infinity, hn::Neg(infinity)), in);
    out = hn::IfThenElse(along, infinity, out);
    enter = hn::Max(enter, in), leave = hn::Min(leave, out);
  }
  return hn::Lt(hn::Max(enter, zero), hn::Min(leave, hn::Set(d, 1.0F)));
}

/// sight[k] becomes what is known of neighbour k of the particle at p. Returns whether any may be hidden.
/// `list` has whole groups, of which `count` are neighbours.
bool findHidden(const Float4* others, const Vec3f& p, std::span<const std::uint32_t> list, std::size_t count,
                std::span<const stages::NearWall> walls, std::uint8_t* HWY_RESTRICT sight) {
  const Pairs d;
  std::uint64_t any = 0;
  const auto bitsOf = [&](auto mask) HWY_ATTR {
    std::uint64_t bits = 0;
    hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
    return bits;
  };
  for (std::size_t k = 0; k < list.size(); k += kPairs) {
    const Components at = loadComponents(others, &list[k]);
    auto hidden = hn::FirstN(d, 0), asked = hidden;
    for (const stages::NearWall& wall : walls) {
      const PairVector height = hn::MulAdd(
          hn::Set(d, wall.normal.x()), at.x,
          hn::MulAdd(hn::Set(d, wall.normal.y()), at.y, hn::Mul(hn::Set(d, wall.normal.z()), at.z)));
      const auto behind = hn::Le(height, hn::Set(d, wall.offset));
      if (hn::AllFalse(d, behind)) continue;
      if (wall.block == nullptr) {
        asked = hn::Or(asked, behind);
      } else {
        hidden = hn::Or(hidden, hn::And(behind, passesThrough(*wall.block, p, at)));
      }
    }
    const std::uint64_t present =
        count - k < kPairs ? (std::uint64_t{1} << (count - k)) - 1 : ~std::uint64_t{0};
    const std::uint64_t hides = bitsOf(hidden) & present, asks = bitsOf(asked) & present & ~hides;
    any |= hides | asks;
    for (std::size_t lane = 0; lane < kPairs; ++lane)
      sight[k + lane] = static_cast<std::uint8_t>((hides >> lane & 1U) | (asks >> lane & 1U) << 1U);
  }
  return any != 0;
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa::stages {

HWY_EXPORT(findHidden);

void separateNeighbours(StepState& state) {
  const float reach = state.supportRadius;
  /// So much of a coordinate's size is a plane farther than rounding tells.
  constexpr float kRounding = 1e-6F;
  const bool hasSlots = state.wallSlot.size() == state.particles.size();
  parallelFor(state.pool, state.particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<NearWall> inReach;
    std::vector<std::uint8_t> sight;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f p = state.current[i].xyz();
      if (hasSlots && knownFarther(state, i, p, reach)) continue;
      inReach.clear();
      for (const auto& [wall, block, vessel] : state.thinWalls.near(p)) {
        NearWall near{wall, block, Vec3f::Zero(), std::numeric_limits<float>::infinity()};
        const Vec3f away = block != nullptr ? block->away(p) : Vec3f(Vec3f::Zero());
        if (const float squared = away.squaredNorm(); squared > 0) {
          if (squared >= reach * reach) continue;
          near.normal = away;  // of any length
          near.offset = away.dot(p) - squared + kRounding * reach * (p.cwiseAbs().sum() + reach);
        } else if (wall->convex()) {
          const float distance = wall->distance(p, near.normal);
          if (distance >= reach) continue;
          if (distance > 0)
            near.offset = near.normal.dot(p) - distance + kRounding * (p.cwiseAbs().sum() + distance);
        } else if (!wall->thinWithin(p, reach, reach)) {
          continue;
        }
        inReach.push_back(near);
      }
      const std::span<const std::uint32_t> list = state.neighbours.groups(i);
      if (inReach.empty() || list.empty()) continue;
      if (sight.size() < list.size()) sight.resize(list.size());
      if (!HWY_DYNAMIC_DISPATCH(findHidden)(state.current.data(), p, list, state.neighbours.counts()[i],
                                            inReach, sight.data()))
        continue;
      state.neighbours.keep(i, [&, k = std::size_t{0}](std::size_t j) mutable {
        const std::uint8_t seen = sight[k++];
        if (seen != kAskWalls) return seen == kSeen;
        const Vec3f other = state.current[j].xyz();
        return std::none_of(inReach.begin(), inReach.end(), [&](const NearWall& near) {
          return near.block == nullptr && near.normal.dot(other) <= near.offset && near.wall->hides(p, other);
        });
      });
    }
  });
}

}  // namespace migiwa::stages
#endif
