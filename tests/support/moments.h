// What a body of particles of one mass has in all, over that mass.
#pragma once

#include <cmath>

#include "core/simulation/frame_view.h"

namespace migiwa::testing {

struct Moments {
  Vec3d momentum = Vec3d::Zero(), angular = Vec3d::Zero(), centre = Vec3d::Zero();
  double speed = 0;    ///< mean length of the velocities (m/s)
  double kinetic = 0;  ///< sum of |v|^2 / 2
};

inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

inline Moments momentsOf(std::span<const Float4> positions, std::span<const Float4> velocities) {
  Moments sums;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3d x = positions[i].xyz().cast<double>(), v = velocities[i].xyz().cast<double>();
    sums.momentum += v, sums.centre += x, sums.angular += cross(x, v);
    sums.speed += v.norm(), sums.kinetic += 0.5 * v.squaredNorm();
  }
  const auto n = static_cast<double>(positions.size());
  sums.centre /= n, sums.speed /= n;
  return sums;
}

inline Moments momentsOf(const FrameView& view) {
  return momentsOf(view.positions, view.velocities);
}

}  // namespace migiwa::testing
