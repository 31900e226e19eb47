// Axis-aligned bounds in metres; empty until something is included.
#pragma once

#include <limits>

#include "core/base/types.h"

namespace migiwa {

struct Bounds {
  Vec3d min = Vec3d::Constant(std::numeric_limits<double>::infinity());
  Vec3d max = Vec3d::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return (min.array() > max.array()).any(); }
  void include(const Vec3d& p) { min = min.cwiseMin(p), max = max.cwiseMax(p); }
  void include(const Bounds& other) { min = min.cwiseMin(other.min), max = max.cwiseMax(other.max); }
  Vec3d center() const { return 0.5 * (min + max); }
  Vec3d size() const { return empty() ? Vec3d(Vec3d::Zero()) : Vec3d(max - min); }
  bool contains(const Vec3d& p) const {
    return (p.array() >= min.array()).all() && (p.array() <= max.array()).all();
  }
  Bounds grown(double by) const {
    Bounds result = *this;
    result.min.array() -= by;
    result.max.array() += by;
    return result;
  }
};

}  // namespace migiwa
