// What lies behind a thin wall is no neighbour: several neighbours at a time against the planes that touch
// the walls nearest to a particle.
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
  Vec3f normal;
  float offset;
};

}  // namespace migiwa::stages
#endif

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// behind[k] becomes whether neighbour k is behind one of the planes. Returns whether any is. `list` has
/// whole groups, of which `count` are neighbours.
bool findBehind(const Float4* others, std::span<const std::uint32_t> list, std::size_t count,
                std::span<const stages::NearWall> walls, std::uint8_t* HWY_RESTRICT behind) {
  const Pairs d;
  bool any = false;
  for (std::size_t k = 0; k < list.size(); k += kPairs) {
    const Components at = loadComponents(others, &list[k]);
    auto some = hn::FirstN(d, 0);
    for (const stages::NearWall& wall : walls) {
      const PairVector height = hn::MulAdd(
          hn::Set(d, wall.normal.x()), at.x,
          hn::MulAdd(hn::Set(d, wall.normal.y()), at.y, hn::Mul(hn::Set(d, wall.normal.z()), at.z)));
      some = hn::Or(some, hn::Le(height, hn::Set(d, wall.offset)));
    }
    std::uint64_t bits = 0;
    hn::StoreMaskBits(d, some, reinterpret_cast<std::uint8_t*>(&bits));
    if (count - k < kPairs) bits &= (std::uint64_t{1} << (count - k)) - 1;
    any = any || bits != 0;
    for (std::size_t lane = 0; lane < kPairs; ++lane)
      behind[k + lane] = static_cast<std::uint8_t>(bits >> lane & 1U);
  }
  return any;
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa::stages {

HWY_EXPORT(findBehind);

void separateNeighbours(StepState& state) {
  const float reach = state.supportRadius;
  /// So much of a coordinate's size is a plane farther than rounding tells.
  constexpr float kRounding = 1e-6F;
  parallelFor(state.pool, state.particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<NearWall> inReach;
    std::vector<std::uint8_t> behind;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f p = state.current[i].xyz();
      inReach.clear();
      for (const auto& [wall, block] : state.thinWalls.near(p)) {
        NearWall near{wall, Vec3f::Zero(), std::numeric_limits<float>::infinity()};
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
      if (behind.size() < list.size()) behind.resize(list.size());
      if (!HWY_DYNAMIC_DISPATCH(findBehind)(state.current.data(), list, state.neighbours.counts()[i], inReach,
                                            behind.data()))
        continue;
      state.neighbours.keep(i, [&, k = std::size_t{0}](std::size_t j) mutable {
        if (behind[k++] == 0) return true;
        const Vec3f other = state.current[j].xyz();
        return std::none_of(inReach.begin(), inReach.end(), [&](const NearWall& near) {
          return near.normal.dot(other) <= near.offset && near.wall->hides(p, other);
        });
      });
    }
  });
}

}  // namespace migiwa::stages
#endif
