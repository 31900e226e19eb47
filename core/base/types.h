// Vectors and the packed particle type that the rest of the program shares.
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace migiwa {

using Vec3f = Eigen::Vector3f;
using Vec3d = Eigen::Vector3d;

/// Three coordinates and one spare lane, loaded by one instruction. What the lane holds is said where it is
/// used.
struct alignas(16) Float4 {
  float x = 0, y = 0, z = 0, w = 0;

  Float4() = default;
  Float4(float ax, float ay, float az, float aw = 0) : x(ax), y(ay), z(az), w(aw) {}
  explicit Float4(const Vec3f& v, float aw = 0) : x(v.x()), y(v.y()), z(v.z()), w(aw) {}
  Vec3f xyz() const { return {x, y, z}; }
  void setXyz(const Vec3f& v) { x = v.x(), y = v.y(), z = v.z(); }
};

}  // namespace migiwa
