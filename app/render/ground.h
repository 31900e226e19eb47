// The plane under the scene: where it lies and how far apart its grid lines are.
#pragma once

#include "core/base/bounds.h"

namespace migiwa {

struct Ground {
  Vec3d center = Vec3d::Zero();  ///< of the scene's footprint, in the plane
  Vec3d up = Vec3d::UnitY(), u = Vec3d::UnitX(), v = Vec3d::UnitZ();
  double extent = 1;       ///< longest side of the scene (m)
  double halfSide = 1;     ///< how far the plane reaches from its centre (m)
  double gridSpacing = 1;  ///< (m)

  double heightOf(const Vec3d& p) const { return (p - center).dot(up); }
};

/// `up` picks the axis nearest to it.
Ground makeGround(const Bounds& scene, const Vec3d& up);

}  // namespace migiwa
