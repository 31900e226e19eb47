// A SLIM surface as triangles, for pictures: the zero set of its signed distance, by marching tetrahedra
// (Doi and Koide 1991) over a body-centred cubic lattice, whose tetrahedra all have the same shape. What the
// fluid does never depends on it.
#pragma once

#include "core/base/parallel.h"
#include "core/slim/slim_model.h"
#include "core/slim/triangle_mesh.h"

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

}  // namespace migiwa
