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

  template <class Visitor>
  static void describe(Visitor& visitor, Visited<Visitor, Rotation>& self) {
    visitor.vector("axis", self.axis,
                   {"1", "Axis through the centre; any length but zero.", Presence::required});
    visitor.number("degrees", self.degrees, Range::closed(-360, 360),
                   {"degrees", "Angle of the turn, right-handed.", Presence::required});
    if constexpr (Visitor::kChanges) {
      if (self.axis.norm() >= 1e-12) return;
      visitor.fault("axis", "expected a vector that is not zero, found [0, 0, 0]");
      self.axis = Vec3d::UnitY();
    }
  }
  Eigen::Matrix3d matrix() const {
    if (degrees == 0) return Eigen::Matrix3d::Identity();
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
  }
};

}  // namespace migiwa
