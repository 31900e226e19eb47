// Closed meshes put together in code.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>

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

/// One along the axes, between two corners.
inline TriangleMesh blockMesh(const Vec3d& low, const Vec3d& high) {
  const Vec3d size = high - low;
  return boxMesh(low, {size.x(), 0, 0}, {0, size.y(), 0}, {0, 0, size.z()});
}

/// A square rod of the given length and width (m) from the origin along a diagonal that no axis is near.
inline TriangleMesh slantedNeedle(double length, double width) {
  const Vec3d along = Vec3d(1, 0.9, 1.1).normalized(), a = along.unitOrthogonal(), b = along.cross(a);
  return boxMesh(-0.5 * width * (a + b), width * a, width * b, length * along);
}

/// A ball of 2 * rings * rings triangles, with its corners on the sphere.
inline TriangleMesh ballMesh(const Vec3d& center, double radius, std::uint32_t rings) {
  TriangleMesh mesh;
  const std::uint32_t around = 2 * rings;
  const auto at = [&](std::uint32_t ring, std::uint32_t k) {
    return ring == 0 ? 0 : ring == rings ? 1 : 2 + (ring - 1) * around + k % around;
  };
  mesh.vertices = {(center + radius * Vec3d::UnitY()).cast<float>(),
                   (center - radius * Vec3d::UnitY()).cast<float>()};
  for (std::uint32_t ring = 1; ring < rings; ++ring) {
    for (std::uint32_t k = 0; k < around; ++k) {
      const double down = std::numbers::pi * ring / rings, turn = 2 * std::numbers::pi * k / around;
      const Vec3d outwards(std::sin(down) * std::sin(turn), std::cos(down), std::sin(down) * std::cos(turn));
      mesh.vertices.emplace_back((center + radius * outwards).cast<float>());
    }
  }
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    for (std::uint32_t k = 0; k < around; ++k) {
      if (ring > 0) mesh.triangles.push_back({at(ring, k), at(ring + 1, k), at(ring, k + 1)});
      if (ring + 1 < rings) mesh.triangles.push_back({at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)});
    }
  }
  return mesh;
}

/// A prism over a regular polygon, with its two ends.
inline TriangleMesh tubeMesh(const Vec3d& from, const Vec3d& to, double radius, std::uint32_t sides) {
  TriangleMesh mesh;
  const Vec3d along = (to - from).normalized(), a = along.unitOrthogonal(), b = along.cross(a);
  mesh.vertices = {from.cast<float>(), to.cast<float>()};
  for (std::uint32_t k = 0; k < sides; ++k) {
    const double turn = 2 * std::numbers::pi * k / sides;
    const Vec3d out = radius * (std::cos(turn) * a + std::sin(turn) * b);
    mesh.vertices.push_back((from + out).cast<float>());
    mesh.vertices.push_back((to + out).cast<float>());
  }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t low = 2 + 2 * k, next = 2 + 2 * ((k + 1) % sides);
    mesh.triangles.insert(
        mesh.triangles.end(),
        {{low, next, low + 1}, {next, next + 1, low + 1}, {0, next, low}, {1, low + 1, next + 1}});
  }
  return mesh;
}

/// Two triangles that span a parallelogram, an open surface whose front is where a, b and it are
/// right-handed.
inline TriangleMesh sheetMesh(const Vec3d& corner, const Vec3d& a, const Vec3d& b) {
  TriangleMesh mesh;
  for (int k = 0; k < 4; ++k)
    mesh.vertices.emplace_back((corner + (k & 1) * a + (k >> 1 & 1) * b).cast<float>());
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  return mesh;
}

/// The parts of one mesh, whose vertices stay apart.
inline TriangleMesh together(const std::vector<TriangleMesh>& parts) {
  TriangleMesh all;
  for (const TriangleMesh& part : parts) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const auto& [a, b, c] : part.triangles) all.triangles.push_back({first + a, first + b, first + c});
  }
  return all;
}

inline TriangleMesh turnedInwards(TriangleMesh mesh) {
  for (auto& corners : mesh.triangles) std::swap(corners[1], corners[2]);
  return mesh;
}

/// The mesh as an OBJ file has it, with all digits.
inline std::string objText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(9);
  for (const Vec3f& v : mesh.vertices) text << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& [a, b, c] : mesh.triangles) text << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  return text.str();
}

/// How often a closed mesh winds about p: the solid angles of its triangles (Van Oosterom and Strackee 1983).
inline double windingNumber(const TriangleMesh& mesh, const Vec3d& p) {
  double sum = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3d a = mesh.vertices[i].cast<double>() - p, b = mesh.vertices[j].cast<double>() - p,
                c = mesh.vertices[k].cast<double>() - p;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return sum / (4 * std::numbers::pi);
}

/// Whether the way from one point to another meets a triangle of the mesh, by the signs of volumes.
inline bool meets(const TriangleMesh& mesh, const Vec3d& from, const Vec3d& to) {
  const auto positive = [](const Vec3d& p, const Vec3d& q, const Vec3d& r, const Vec3d& s) {
    return (q - p).cross(r - p).dot(s - p) > 0;
  };
  return std::any_of(
      mesh.triangles.begin(), mesh.triangles.end(), [&](const std::array<std::uint32_t, 3>& t) {
        const Vec3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                    c = mesh.vertices[t[2]].cast<double>();
        if (positive(a, b, c, from) == positive(a, b, c, to)) return false;
        const bool side = positive(from, to, a, b);
        return side == positive(from, to, b, c) && side == positive(from, to, c, a);
      });
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
