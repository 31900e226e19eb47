// Points of a solid's surface with normals that point out of the solid: what SLIM surfaces are fitted to.
#pragma once

#include <vector>

#include "core/base/types.h"

namespace migiwa {

struct OrientedPoint {
  Vec3f position;  ///< (m)
  Vec3f normal;    ///< unit, out of the solid
};

struct OrientedPoints {
  std::vector<OrientedPoint> points;
  /// Whether they cover the whole surface of a solid, so that every point of space is inside or outside.
  bool closed = true;
};

}  // namespace migiwa
