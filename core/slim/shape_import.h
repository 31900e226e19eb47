// Meshes and oriented point clouds from files: OBJ, PLY, STL and what else assimp reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/slim/oriented_points.h"
#include "core/slim/triangle_mesh.h"

namespace migiwa {

/// What a file holds, checked and repaired where that is safe: a mesh, or points with normals, which
/// are estimated where the file has none.
struct ImportedShape {
  TriangleMesh mesh;               ///< no triangles: the file holds points
  OrientedPoints cloud;            ///< no points: the file holds a mesh
  bool closed = true;              ///< encloses a solid
  std::vector<std::string> notes;  ///< what was repaired, and what is probably not meant; one sentence each

  bool isMesh() const { return !mesh.triangles.empty(); }
  Bounds bounds() const;
};

/// Throws InputError, its place the file, when the file is missing, holds no surface, or one that cannot be
/// told inside from outside.
ImportedShape importShape(const std::filesystem::path& file);

/// The points that a SLIM surface of about so many nodes (0: not known) is fitted to.
OrientedPoints fitPoints(const ImportedShape& shape, int nodes);

}  // namespace migiwa
