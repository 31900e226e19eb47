// Shapes whose distance is known, and points spread evenly over them.
#pragma once

#include <cmath>
#include <numbers>

#include "core/slim/points.h"

namespace migiwa::testing {

/// A sphere about the origin.
struct ExactSphere {
  double radius = 1;

  double distance(const Vec3d& p, Vec3d& normal) const {
    normal = p.normalized();
    return p.norm() - radius;
  }
  OrientedPoints points(std::size_t count) const {
    OrientedPoints result;
    for (std::size_t k = 0; k < count; ++k) {
      const double y = 1 - (2 * static_cast<double>(k) + 1) / static_cast<double>(count);
      const double angle = std::numbers::pi * (3 - std::sqrt(5.0)) * static_cast<double>(k);
      const double across = std::sqrt(1 - y * y);
      const Vec3d normal(across * std::cos(angle), y, across * std::sin(angle));
      result.points.push_back({(radius * normal).cast<float>(), normal.cast<float>()});
    }
    return result;
  }
};

/// A torus about the y axis.
struct ExactTorus {
  double ring = 1, tube = 0.4;

  double distance(const Vec3d& p, Vec3d& normal) const {
    const double across = std::hypot(p.x(), p.z());
    const Vec3d middle(ring * p.x() / across, 0, ring * p.z() / across);
    normal = (p - middle).normalized();
    return (p - middle).norm() - tube;
  }
  OrientedPoints points(std::size_t count) const {
    OrientedPoints result;
    for (std::size_t k = 0; k < count; ++k) {
      const double share = 2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
      // Equal areas: turn + (tube / ring) sin(turn) = share.
      double turn = share;
      for (int step = 0; step < 30; ++step)
        turn -= (turn + tube / ring * std::sin(turn) - share) / (1 + tube / ring * std::cos(turn));
      const double angle = std::numbers::pi * (3 - std::sqrt(5.0)) * static_cast<double>(k);
      const Vec3d around(std::cos(angle), 0, std::sin(angle));
      const Vec3d normal = std::cos(turn) * around + std::sin(turn) * Vec3d::UnitY();
      result.points.push_back({(ring * around + tube * normal).cast<float>(), normal.cast<float>()});
    }
    return result;
  }
};

}  // namespace migiwa::testing
