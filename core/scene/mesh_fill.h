// The cells of a lattice whose centres lie in a closed mesh. The cost follows the mesh: only columns of cells
// that it crosses are looked at, and of each only the cells within, however much of its bounding box is
// empty.
#pragma once

#include <cstdint>
#include <vector>

#include "core/slim/triangle_mesh.h"

namespace migiwa {

/// What filling took, for tests of its cost.
struct MeshFillWork {
  std::int64_t lines = 0;    ///< rows of columns that were cut with a triangle
  std::int64_t columns = 0;  ///< columns that were tested against a triangle
  std::int64_t cells = 0;    ///< cells that were filled
  std::size_t mostHeld = 0;  ///< crossings and cells that were held at once beside the result
};

/// Appends the centres of the cells that lie in the mesh, by z, then y, then x. The lattice has
/// round(length / spacing) cells along each axis of the mesh's bounds, centred on them. `spacing` in m; the
/// lattice must have fewer than 2^53 cells along each axis.
MeshFillWork fillMesh(const TriangleMesh& mesh, double spacing, std::vector<Vec3d>& out);

}  // namespace migiwa
