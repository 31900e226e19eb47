// What pictures show of walls: plain data, in the scene's space (m).
#pragma once

#include <vector>

#include "core/slim/triangle_mesh.h"

namespace migiwa {

struct LineSegment {
  Vec3f from, to;
};

/// A wall to be shaded. Seen from the fluid its triangles run counter-clockwise.
struct WallMesh {
  TriangleMesh surface;
  std::vector<Vec3f> normals;  ///< at each vertex, unit, into the fluid
  bool vessel = false;         ///< holds the fluid, so that its near side must not hide what is within
};

/// The core of a ball of a SLIM surface, as a disc that touches the surface.
struct WallNode {
  Vec3f centre;      ///< on the surface (m)
  Vec3f normal;      ///< unit, into the fluid
  float ballRadius;  ///< (m)
  float discRadius;  ///< (m)
  bool vessel;       ///< as of its WallMesh
};

struct WallDrawing {
  std::vector<LineSegment> lines;
  std::vector<WallMesh> meshes;
  std::vector<WallNode> nodes;
};

}  // namespace migiwa
