// What holds of a closed mesh, checked without a line of the code that makes it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/surface/mesh.h"

namespace migiwa::testing {

struct MeshFaults {
  long edges = 0;     ///< that do not belong to two triangles in opposite directions
  long vertices = 0;  ///< without triangles, or whose triangles are no single fan
  long folded = 0;    ///< triangles that name a vertex twice, or a vertex that is not there
  long total() const { return edges + vertices + folded; }
};

inline MeshFaults faultsOf(const SurfaceMesh& mesh) {
  MeshFaults faults;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::vector<std::map<std::uint32_t, std::uint32_t>> fans(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3], c = triangle[(k + 2) % 3];
      if (a == b || a >= mesh.positions.size()) {
        ++faults.folded;
        continue;
      }
      ++edges[{a, b}];
      fans[a][b] = c;
    }
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) ++faults.edges;
  }
  for (const auto& fan : fans) {
    std::size_t turns = 0;
    if (!fan.empty()) {
      std::uint32_t at = fan.begin()->first;
      do {
        const auto next = fan.find(at);
        if (next == fan.end()) break;
        at = next->second;
        ++turns;
      } while (at != fan.begin()->first && turns <= fan.size());
    }
    if (fan.empty() || turns != fan.size()) ++faults.vertices;
  }
  return faults;
}

/// How far (m) the segment from p to q pierces the inside of the triangle: the least of the distances of p
/// and q from its plane and of the point of passage from its edges; 0 where it does not.
inline double pierced(const Vec3d& p, const Vec3d& q, const std::array<Vec3d, 3>& t) {
  const Vec3d area = (t[1] - t[0]).cross(t[2] - t[0]);
  const double size = area.norm();
  if (size <= 0) return 0;
  const Vec3d normal = area / size;
  const double above = normal.dot(p - t[0]), below = normal.dot(q - t[0]);
  if (above * below >= 0) return 0;
  const Vec3d at = p + above / (above - below) * (q - p);
  double depth = std::min(std::abs(above), std::abs(below));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d edge = t[(k + 1) % 3] - t[k];
    depth = std::min(depth, normal.dot(edge.cross(at - t[k])) / std::max(edge.norm(), 1e-30));
  }
  return std::max(depth, 0.0);
}

/// Pairs of triangles without a common vertex that pass through each other by more than `tolerance` (m).
/// `cell` (m) is about as long as the longest edges.
inline long crossingsOf(const SurfaceMesh& mesh, double cell, double tolerance) {
  using Key = std::array<int, 3>;
  std::map<Key, std::vector<std::uint32_t>> cells;
  const auto corner = [&](std::uint32_t t, std::size_t k) -> Vec3d {
    return mesh.positions[mesh.triangles[t][k]].cast<double>();
  };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Vec3d low = corner(t, 0), high = low;
    for (std::size_t k = 1; k < 3; ++k) low = low.cwiseMin(corner(t, k)), high = high.cwiseMax(corner(t, k));
    Key from, to;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      from[axis] = static_cast<int>(std::floor(low[static_cast<int>(axis)] / cell));
      to[axis] = static_cast<int>(std::floor(high[static_cast<int>(axis)] / cell));
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
        for (int x = from[0]; x <= to[0]; ++x) cells[{x, y, z}].push_back(t);
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> crossing;
  for (const auto& [key, members] : cells) {
    for (const std::uint32_t a : members) {
      const std::array<Vec3d, 3> ta{corner(a, 0), corner(a, 1), corner(a, 2)};
      const auto& va = mesh.triangles[a];
      for (const std::uint32_t b : members) {
        const auto& vb = mesh.triangles[b];
        if (a == b || std::find_first_of(va.begin(), va.end(), vb.begin(), vb.end()) != va.end()) continue;
        for (std::size_t k = 0; k < 3; ++k)
          if (pierced(corner(b, k), corner(b, (k + 1) % 3), ta) > tolerance)
            crossing.insert(std::minmax(a, b));
      }
    }
  }
  return static_cast<long>(crossing.size());
}

}  // namespace migiwa::testing
