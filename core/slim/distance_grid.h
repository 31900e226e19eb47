// Signed distances to a surface on a coarse grid over its surroundings: cheap far from the surface, and a
// first guess near it. Points far inside a closed surface are known by the sign.
#pragma once

#include <vector>

#include "core/base/bounds.h"
#include "core/slim/oriented_points.h"

namespace migiwa {

class DistanceGrid {
 public:
  struct Sample {
    float distance;  ///< (m)
    Vec3f gradient;  ///< of the interpolated distance; about 1 long away from the medial axis
  };

  /// `points` lie on the surface less than half of `cell` (m) apart.
  DistanceGrid(const std::vector<OrientedPoint>& points, bool closed, float cell);

  Sample at(const Vec3f& p) const;
  float cell() const { return cell_; }

  /// The edge of a cell (m) for a surface of this extent whose details have this size (m): fine enough for
  /// them if memory allows.
  static float cellFor(const Bounds& bounds, float detail);

 private:
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(x);
  }
  Vec3f vertex(int x, int y, int z) const {
    return origin_ + cell_ * Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  }
  void spread(const std::vector<OrientedPoint>& points, std::vector<std::int32_t>& nearest) const;
  void agreeOnSigns(const std::vector<std::uint8_t>& band);

  float cell_, inverseCell_;
  Vec3f origin_;
  Eigen::Vector3i size_;
  std::vector<float> distances_;
};

}  // namespace migiwa
