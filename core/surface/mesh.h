// The surface of a liquid as a closed mesh: what core/surface makes and pictures and files take.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/math.h"

namespace migiwa {

/// A closed mesh around the liquid: every edge belongs to two triangles, which run along it in opposite
/// directions. Per vertex are positions, normals and velocities, per triangle the rest.
struct SurfaceMesh {
  std::vector<Vec3f> positions;   ///< (m), relative to Scene::origin
  std::vector<Vec3f> normals;     ///< unit, out of the liquid; at a wall's rim the free surface's
  std::vector<Vec3f> velocities;  ///< of the liquid at the vertex (m/s)
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside the liquid
  std::vector<std::uint8_t> wet;  ///< 1 where the liquid touches a wall, 0 where it is free

  bool empty() const { return triangles.empty(); }
};

}  // namespace migiwa
