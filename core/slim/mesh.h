// A SLIM surface as triangles, for pictures: the zero set of its signed distance, by marching tetrahedra
// (Doi and Koide 1991) over a body-centred cubic lattice, whose tetrahedra all have the same shape. What the
// fluid does never depends on it.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/slim/model.h"
#include "core/slim/points.h"

namespace migiwa {

struct SlimMesh {
  TriangleMesh surface;        ///< counter-clockwise seen from outside
  std::vector<Vec3f> normals;  ///< of the surface at each vertex: unit, outwards
};

/// Triangles that a mesh has at most, give or take a tenth.
inline constexpr double kMostSlimTriangles = 140000;

/// Vertices lie on the blended surface to a thousandth of a cell, unless nodes contradict each other there.
/// Cells are as fine as the nodes' sizes ask for and `mostTriangles` allows. The mesh of a closed model is
/// closed: two triangles meet at every edge. That of an open one ends where the balls' cores end. The same
/// for any number of threads.
SlimMesh extractSlimMesh(const SlimModel& model, ThreadPool& pool, double mostTriangles = kMostSlimTriangles);

// A body-centred cubic lattice: the corners and the centres of cubic cells. Two centres that share a face of
// their cells, and two corners beside each other on that face, make a tetrahedron; all have the same shape.

class TetrahedraLattice {
 public:
  /// Numbers of the four corners, so that the last three run counter-clockwise seen from outside.
  using Tetrahedron = std::array<std::uint32_t, 4>;

  /// Covers `cells` cubes with edges of `cell` (m) along each axis, from `origin` on.
  TetrahedraLattice(const Vec3f& origin, float cell, const Eigen::Vector3i& cells)
      : origin_(origin), cell_(cell), size_((cells.array() + 1).matrix()) {}

  float cell() const { return cell_; }
  const Eigen::Vector3i& size() const { return size_; }  ///< corners along each axis
  std::size_t points() const {
    return 2 * static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
           static_cast<std::size_t>(size_.z());
  }
  /// The number of a cell's lower corner, and with `centre` 1 of the cell's centre.
  std::uint32_t point(const Eigen::Vector3i& at, std::uint32_t centre) const {
    return 2 * static_cast<std::uint32_t>((at.z() * size_.y() + at.y()) * size_.x() + at.x()) + centre;
  }
  Vec3f position(std::uint32_t point) const {
    const auto index = static_cast<int>(point / 2);
    const Eigen::Vector3i at(index % size_.x(), index / size_.x() % size_.y(), index / size_.x() / size_.y());
    return origin_ + cell_ * (at.cast<float>().array() + (point % 2 != 0 ? 0.5F : 0.0F)).matrix();
  }

  /// Calls visit(tetrahedron) for the four about each of the three axes that begin at a cell's centre, as far
  /// as the lattice goes.
  template <class Visit>
  void visitTetrahedra(const Eigen::Vector3i& at, const Visit& visit) const {
    const std::uint32_t from = point(at, 1);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3i along = Eigen::Vector3i::Unit(axis), side = Eigen::Vector3i::Unit((axis + 1) % 3),
                            other = Eigen::Vector3i::Unit((axis + 2) % 3);
      const Eigen::Vector3i face = at + along;
      if (((face + side + other).array() >= size_.array()).any()) continue;
      const std::uint32_t to = point(face, 1);
      const std::array<std::uint32_t, 5> around{point(face, 0), point(face + side, 0),
                                                point(face + side + other, 0), point(face + other, 0),
                                                point(face, 0)};
      for (std::size_t k = 0; k < 4; ++k) visit(Tetrahedron{from, to, around[k], around[k + 1]});
    }
  }

 private:
  Vec3f origin_;
  float cell_;
  Eigen::Vector3i size_;
};

}  // namespace migiwa
