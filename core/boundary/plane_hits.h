// First hits of rays with one plane: what planes and the faces of boxes share.
#pragma once

#include <algorithm>
#include <span>

#include "core/boundary/directions.h"

namespace migiwa {

/// For an origin at `distance` (m) on the fluid side of a plane with the given unit normal into the fluid.
inline void hitPlane(const Vec3f& normal, float distance, const Directions& directions,
                     std::span<float> hits) {
  const float nx = normal.x(), ny = normal.y(), nz = normal.z(), d = std::max(distance, 1e-9F);
  const float *x = directions.x.data(), *y = directions.y.data(), *z = directions.z.data();
  float* hit = hits.data();
  for (std::size_t k = 0; k < hits.size(); ++k) {
    // A ray that runs along the plane or away from it gets a hit beyond every reach, also from the plane
    // itself.
    const float towards = std::max(-(nx * x[k] + ny * y[k] + nz * z[k]), 1e-12F);
    hit[k] = std::min(hit[k], d / towards);
  }
}

}  // namespace migiwa
