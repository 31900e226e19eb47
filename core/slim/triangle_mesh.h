// Triangles over shared vertices.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/types.h"

namespace migiwa {

struct TriangleMesh {
  std::vector<Vec3f> vertices;  ///< (m)
  std::vector<std::array<std::uint32_t, 3>>
      triangles;  ///< counter-clockwise seen from the fluid's side, or outside

  Bounds bounds() const {
    Bounds bounds;
    for (const Vec3f& vertex : vertices) bounds.include(vertex.cast<double>());
    return bounds;
  }
};

}  // namespace migiwa
