#include "core/scene/mesh_source.h"

#include <cmath>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/scene/mesh_fill.h"
#include "core/slim/slim_fitting.h"

namespace migiwa {

MeshSource::MeshSource(TriangleMesh mesh) : mesh_(std::move(mesh)) {
  measure();
}

template <class Visitor>
void MeshSource::fields(Visitor& visitor, Visited<Visitor, MeshSource>& self) {
  visitor.file("file", self.file_,
               {"", "OBJ, PLY, STL, ...: a closed mesh. Relative to the scene file.", Presence::required});
  visitor.object("transform", {"", "Where the shape of the file stands in the scene."},
                 [&](auto& transform) { Transform::describe(transform, self.transform_); });
}

void MeshSource::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void MeshSource::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  if (!visitor.sound({"file", "transform"})) return;
  try {
    ImportedShape shape = importShape(file_.path);
    requireUnchanged(file_.path, file_.identity);
    if (!shape.isMesh() || !shape.closed) {
      visitor.fault("file", "expected a closed mesh, found one that is open or has no triangles (" +
                                file_.path.string() + ")");
      return;
    }
    transformShape(shape, transform_);
    for (const std::string& note : shape.notes) visitor.warning("file", file_.path.string() + ": " + note);
    mesh_ = std::move(shape.mesh);
  } catch (const InputError& error) {
    for (const Fault& fault : error.faults()) visitor.fault("file", fault.message + " (" + fault.place + ")");
    return;
  }
  measure();
}

void MeshSource::measure() {
  volume_ = area_ = 0;
  if (mesh_.vertices.empty()) return;
  const Vec3d origin = mesh_.bounds().center();
  for (const auto& [a, b, c] : mesh_.triangles) {
    const Vec3d p = mesh_.vertices[a].cast<double>() - origin, q = mesh_.vertices[b].cast<double>() - origin,
                r = mesh_.vertices[c].cast<double>() - origin;
    volume_ += p.dot(q.cross(r)) / 6;
    area_ += (q - p).cross(r - p).norm() / 2;
  }
}

double MeshSource::count(double spacing) const {
  // A cell whose centre is inside reaches at most half a diagonal beyond the surface.
  return std::floor((std::abs(volume_) + 0.5 * std::sqrt(3.0) * spacing * area_) /
                    (spacing * spacing * spacing));
}

void MeshSource::fill(double spacing, std::vector<Vec3d>& out) const {
  fillMesh(mesh_, spacing, out);
}

}  // namespace migiwa
