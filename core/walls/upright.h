// Boxes along the axes. What a wall that is one is asked most is answered without a virtual call. All in m.
#pragma once

#include <cmath>

#include "core/base/math.h"

namespace migiwa {

/// Moves a point, seen from the centre of a box of these half edges, out of it until it is `margin` away.
/// Returns whether it moved.
inline bool pushOutOfBox(Vec3f& local, const Vec3f& half, float margin) {
  const Vec3f beyond = local.cwiseAbs() - half;
  if (beyond.maxCoeff() > 0) {
    const Vec3f positive = beyond.cwiseMax(0.0F);
    const float outside = positive.norm();
    if (outside >= margin) return false;
    for (int axis = 0; axis < 3; ++axis)
      local[axis] += std::copysign(positive[axis] * (margin / outside - 1), local[axis]);
  } else {
    int axis = 0;
    beyond.maxCoeff(&axis);
    local[axis] = std::copysign(half[axis] + margin, local[axis]);
  }
  return true;
}

/// The same into the box, until it is `margin` away from all faces; midway where there is no room.
inline bool pullIntoBox(Vec3f& local, const Vec3f& half, float margin) {
  const Vec3f room = (half.array() - margin).max(0.0F);
  const Vec3f clamped = local.cwiseMax(-room).cwiseMin(room);
  if (clamped == local) return false;
  local = clamped;
  return true;
}

/// A block with the fluid around it.
struct UprightBlock {
  Vec3f center, half;  ///< half: of its edges
  Vec3f low, high;     ///< corners

  float thickness() const { return 2 * half.minCoeff(); }
  /// How far p is beyond the faces across each axis; negative: within.
  Vec3f beyond(const Vec3f& p) const { return (p - center).cwiseAbs() - half; }
  /// The way (m) to p from the nearest point of the block; zero inside.
  Vec3f away(const Vec3f& p) const { return p - p.cwiseMax(low).cwiseMin(high); }
  /// Squared distance (m^2) of a point outside; 0 inside.
  float squaredDistance(const Vec3f& p) const { return beyond(p).cwiseMax(0.0F).squaredNorm(); }
  /// Whether p is certainly farther away than `distance` (m), rounding included.
  bool farther(const Vec3f& p, float distance) const {
    constexpr float kSurely = 1.0001F;
    return squaredDistance(p) > kSurely * distance * distance;
  }
  /// As Surface::project().
  bool project(Vec3f& p, float margin) const {
    Vec3f local = p - center;
    if (!pushOutOfBox(local, half, margin)) return false;
    p = center + local;
    return true;
  }
};

/// A tank with the fluid inside.
struct UprightVessel {
  Vec3f center, half;  ///< half: of its edges

  /// Whether project() would leave p where it is.
  bool holds(const Vec3f& p, float margin) const {
    const Vec3f local = (p - center).cwiseAbs();
    const Vec3f room = (half.array() - margin).max(0.0F);
    return (local.x() <= room.x()) & (local.y() <= room.y()) & (local.z() <= room.z());
  }
  /// As Surface::distance().
  float distance(const Vec3f& p) const {
    const Vec3f beyond = (p - center).cwiseAbs() - half;
    const float most = beyond.maxCoeff();
    return most > 0 ? -beyond.cwiseMax(0.0F).norm() : -most;
  }
  /// As Surface::project().
  bool project(Vec3f& p, float margin) const {
    Vec3f local = p - center;
    if (!pullIntoBox(local, half, margin)) return false;
    p = center + local;
    return true;
  }
};

}  // namespace migiwa
