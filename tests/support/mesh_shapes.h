// Closed meshes put together in code.
#pragma once

#include <cmath>

#include "core/slim/points.h"

namespace migiwa::testing {

/// A box with one corner at `corner` and edges along three vectors that are right-handed.
inline TriangleMesh boxMesh(const Vec3d& corner, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.emplace_back((corner + (k & 1) * a + (k >> 1 & 1) * b + (k >> 2 & 1) * c).cast<float>());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A square rod of the given length and width (m) from the origin along a diagonal that no axis is near.
inline TriangleMesh slantedNeedle(double length, double width) {
  const Vec3d along = Vec3d(1, 0.9, 1.1).normalized(), a = along.unitOrthogonal(), b = along.cross(a);
  return boxMesh(-0.5 * width * (a + b), width * a, width * b, length * along);
}

/// By how many cells, quarters below 1, a lattice with a cell at `center` lies below one with a cell at
/// `first`.
inline Vec3d movedBy(const Vec3d& center, const Vec3d& first, double spacing) {
  return ((first - center) / spacing).unaryExpr([](double cells) {
    const double quarters = std::round(4 * cells);
    return (quarters - 4 * std::floor(quarters / 4)) / 4;
  });
}

}  // namespace migiwa::testing
