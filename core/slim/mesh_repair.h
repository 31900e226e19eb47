// Makes a mesh as files hold them into one that has an inside and an outside.
#pragma once

#include <string>
#include <vector>

#include "core/slim/triangle_mesh.h"

namespace migiwa {

/// Welds vertices at the same place, drops triangles that are degenerate or there twice, and turns triangles
/// so that all face outwards. Adds a sentence to `notes` for each kind of repair, and for an open mesh.
/// Returns whether the mesh is closed. Throws InputError at `place` for fewer than 4 triangles, edges of more
/// than two triangles and surfaces with one side only.
bool repairMesh(TriangleMesh& mesh, const std::string& place, std::vector<std::string>& notes);

}  // namespace migiwa
