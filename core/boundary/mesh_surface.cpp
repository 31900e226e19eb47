#include "core/boundary/mesh_surface.h"

namespace migiwa {

void MeshSurface::describe(FieldVisitor& visitor) {
  describeFluid(visitor);
  visitor.file("file", file_,
               {"", "OBJ, PLY, STL, ...: triangles, or points with normals. Relative to the scene file.",
                Presence::required});
  describeTransform(visitor);
  if (!visitor.sound({"file"})) return;
  source_.kind = SlimSource::Kind::mesh;
  source_.file = file_.path;
  prepare(visitor, "file");
}

}  // namespace migiwa
