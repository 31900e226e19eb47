// A turn about an axis through something's centre, as scenes write it.
#pragma once

#include <numbers>

#include <Eigen/Geometry>

#include "core/base/fields.h"
#include "core/base/types.h"

namespace migiwa {

struct Rotation {
  Vec3d axis = Vec3d::UnitY();
  double degrees = 0;

  void describe(FieldVisitor& visitor) {
    visitor.vector("axis", axis, {"1", "Axis through the centre; any length but zero.", Presence::required});
    visitor.number("degrees", degrees, Range::closed(-360, 360),
                   {"degrees", "Angle of the turn, right-handed.", Presence::required});
    if (axis.norm() < 1e-12) {
      visitor.fault("axis", "expected a vector that is not zero, found [0, 0, 0]");
      axis = Vec3d::UnitY();
    }
  }
  Eigen::Matrix3d matrix() const {
    if (degrees == 0) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
  }
};

}  // namespace migiwa
