// A bowl or glass by formula: all points within half a thickness of the lower half of a sphere and of the
// cylinder that stands on it, so that its rim is rounded. For scenes that need no file, and for tests: its
// distance is known exactly.
#pragma once

#include "core/slim/oriented_points.h"

namespace migiwa {

struct Bowl {
  Vec3d center = Vec3d::Zero();  ///< of the sphere (m)
  double radius = 1;             ///< of the sphere midway in the wall (m)
  double thickness = 0.2;        ///< of the wall (m), less than the diameter
  double height = 0;             ///< of the rim above the centre (m): 0 is a bowl, more a glass

  bool operator==(const Bowl&) const = default;
};

/// Signed distance of p (m), positive outside the solid, and the unit normal at the nearest point.
double bowlDistance(const Bowl& bowl, const Vec3d& p, Vec3d& normal);

/// About `count` points spread evenly over its surface, with exact positions and normals.
OrientedPoints bowlPoints(const Bowl& bowl, std::size_t count);

}  // namespace migiwa
