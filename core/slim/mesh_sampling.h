// Points spread evenly over a mesh.
#pragma once

#include "core/slim/oriented_points.h"
#include "core/slim/triangle_mesh.h"

namespace migiwa {

/// About `count` points, as many to every triangle as its area asks for, evenly spread within it, with the
/// triangles' normals. Other seeds give other points.
std::vector<OrientedPoint> samplePoints(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed);

/// As many as a fit of this many nodes (0: not known) needs.
std::size_t sampleCount(const TriangleMesh& mesh, int nodes);

}  // namespace migiwa
