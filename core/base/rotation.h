// A turn about an axis through something's centre, as scenes write it.
#pragma once

#include <numbers>

#include <Eigen/Core>

#include "core/base/fields.h"
#include "core/base/portable_math.h"
#include "core/base/types.h"

namespace migiwa {

/// The right-handed turn by an angle (rad) about a unit axis, after Rodrigues.
inline Eigen::Matrix3d rotationAbout(const Vec3d& axis, double angle) {
  const double sine = portable::sin(angle), cosine = portable::cos(angle);
  Eigen::Matrix3d across;  // of the cross product with the axis
  across << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return cosine * Eigen::Matrix3d::Identity() + sine * across + (1 - cosine) * (axis * axis.transpose());
}

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
    return rotationAbout(axis.normalized(), degrees * std::numbers::pi / 180);
  }
};

}  // namespace migiwa
