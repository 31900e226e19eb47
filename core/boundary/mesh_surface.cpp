#include "core/boundary/mesh_surface.h"

namespace migiwa {

template <class Visitor>
void MeshSurface::fields(Visitor& visitor, Visited<Visitor, MeshSurface>& self) {
  describeFluid(visitor, self);
  visitor.file("file", self.file_,
               {"", "OBJ, PLY, STL, ...: triangles, or points with normals. Relative to the scene file.",
                Presence::required});
  describeTransform(visitor, self);
}

void MeshSurface::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void MeshSurface::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  if (!visitor.sound({"file"})) return;
  setFile(SlimSource::Kind::mesh, file_);
  prepare(visitor, "file");
}

}  // namespace migiwa
