// A box that holds the fluid and nothing else: where levels, edges and depths are known exactly.
#pragma once

#include <optional>

#include "core/scene/scene.h"

namespace migiwa {

struct UprightTank {
  Vec3d center;          ///< (m)
  Eigen::Matrix3d axes;  ///< columns; the second points up
  Vec3d half;            ///< along those axes (m)

  /// Of a point above the floor (m).
  double heightOf(const Vec3d& p) const { return axes.col(1).dot(p - center) + half.y(); }
  /// Level (m above the floor) of so much fluid (m^3), filled evenly.
  double levelOf(double volume) const { return volume / (4 * half.x() * half.z()); }
};

/// The box that holds the fluid, if gravity runs along one of its axes and nothing else stands in it.
std::optional<UprightTank> uprightTank(const Scene& scene);

}  // namespace migiwa
