// How a wall moves, as scenes write it: at a constant velocity, in a turn about an axis, to and fro, or by
// keyframes; what is named adds up. A motion is a function of time alone, so nothing of it needs saving.
#pragma once

#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "core/base/fields.h"
#include "core/base/types.h"

namespace migiwa {

/// A rigid move: a rotation and a translation after it (m).
using Pose = Eigen::Isometry3d;

/// Where a wall is at a time, relative to where the scene puts it.
struct Keyframe {
  double time = 0;                  ///< (unit: s)
  Vec3d translate = Vec3d::Zero();  ///< (unit: m)
  double degrees = 0;               ///< about the motion's axis (unit: degrees)
};

/// How places between keyframes follow.
enum class Interpolation {
  smooth,  ///< at rest at each keyframe: 3 s^2 - 2 s^3 of the way
  linear   ///< at a constant velocity from one to the next
};

struct Motion {
  Vec3d velocity = Vec3d::Zero();  ///< (unit: m/s)

  bool turns = false;           ///< whether there is an axis
  Vec3d axis = Vec3d::UnitY();  ///< of every turn, right-handed; it moves along with the wall
  Vec3d point = Vec3d::Zero();  ///< of the axis (unit: m)
  double degreesPerSecond = 0;  ///< (unit: degrees/s)

  bool oscillates = false;
  Vec3d amplitude = Vec3d::Zero();  ///< of the sway (unit: m)
  double swing = 0;                 ///< amplitude of the turn about the axis (unit: degrees)
  double period = 1;                ///< (unit: s)

  double start = 0;   ///< velocity, turn and oscillation begin (unit: s)
  double stop = 1e6;  ///< and end, and the wall stays where it is then (unit: s)

  std::vector<Keyframe> keyframes;
  Interpolation interpolation = Interpolation::smooth;

  /// Visits the keys of the scene's object "motion", then checks what follows from them.
  void describe(FieldVisitor& visitor);
  void describe(FieldWriter& visitor) const;
  /// From where the scene puts the wall to where it is at `time` (s).
  Pose at(double time) const;
  /// Whether two walls with these motions never move relative to each other.
  bool sameAs(const Motion& other) const;
};

}  // namespace migiwa
