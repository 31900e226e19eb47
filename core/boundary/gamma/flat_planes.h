// Walls that are nothing but planes with the fluid inside all of them, such as a box tank: a flat list that
// the inner loops run over without a virtual call.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/boundary/boundary.h"
#include "core/boundary/gamma/half_spaces.h"

namespace migiwa {

/// Distances over the support radius: e = normal . p / h + offset, positive in the fluid.
struct FlatPlane {
  Vec3f normal;  ///< unit, into the fluid, over the support radius
  float offset;
  Vec3f unit;  ///< unit, into the fluid
  float at(const Vec3f& p) const { return normal.dot(p) + offset; }
};

class FlatPlanes {
 public:
  /// More than this many are left to a search of what is in reach.
  static constexpr std::size_t kMostPlanes = 64;
  /// Nothing where a surface is curved or a block, or where two planes are so nearly one that which of them
  /// counts depends on the place.
  static std::optional<FlatPlanes> of(const Boundary& boundary, float supportRadius);

  std::span<const FlatPlane> planes() const { return planes_; }
  /// Parallel planes that face each other are one axis; -1: there is no second.
  struct Axis {
    int first, second;
  };
  std::span<const Axis> axes() const { return axes_; }
  /// Whether all axes are at right angles.
  bool rightAngled() const { return oblique_.empty(); }
  /// Whether two axes that are not at right angles are both in reach of p.
  bool obliqueAt(const Vec3f& p) const;
  /// The planes in reach of p as half-spaces.
  void inReach(const Vec3f& p, std::vector<HalfSpace>& set) const;

 private:
  std::vector<FlatPlane> planes_;
  std::vector<Axis> axes_;
  std::vector<std::pair<int, int>> oblique_;
};

}  // namespace migiwa
