// Small balls around sets of points that are joined again and again.
#pragma once

#include <array>

#include "core/base/types.h"

namespace migiwa {

/// The farthest points of a set in 26 directions. Those of the union of two sets are found among theirs.
class Extremes {
 public:
  void include(const Vec3f& p);
  void include(const Extremes& other);
  /// Near the centre of the smallest ball around the points: that ball about it is some hundredths wider. At
  /// least one point must have been included.
  Vec3f centre() const;

 private:
  static constexpr std::size_t kDirections = 26;
  std::array<Vec3f, kDirections> points_;
  std::array<float, kDirections> reaches_;
  bool any_ = false;
};

}  // namespace migiwa
