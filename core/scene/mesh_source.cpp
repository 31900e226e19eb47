#include "core/scene/mesh_source.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/base/error.h"
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
  return std::floor((volume_ + 0.5 * std::sqrt(3.0) * spacing * area_) / (spacing * spacing * spacing));
}

void MeshSource::fill(double spacing, std::vector<Vec3d>& out) const {
  if (mesh_.triangles.empty()) return;
  const Bounds bounds = mesh_.bounds();
  const Eigen::Array3d cells = (bounds.size() / spacing).array().round();
  const Vec3d first = bounds.center() - 0.5 * spacing * (cells - 1).matrix();
  const auto nx = static_cast<std::int64_t>(cells.x()), ny = static_cast<std::int64_t>(cells.y()),
             nz = static_cast<std::int64_t>(cells.z());
  if (nx <= 0 || ny <= 0 || nz <= 0) return;
  // Where the vertical line through each column of cells passes the surface. A line that runs exactly through
  // an edge would count it twice or not at all: a shift that no mesh has avoids that.
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(nx * nz));
  const double shiftX = 1.2345e-7 * spacing, shiftZ = 2.7183e-7 * spacing;
  for (const auto& [a, b, c] : mesh_.triangles) {
    const Vec3d p = mesh_.vertices[a].cast<double>(), q = mesh_.vertices[b].cast<double>(),
                r = mesh_.vertices[c].cast<double>();
    const auto range = [&](int axis, std::int64_t n) {
      const double low = std::min({p[axis], q[axis], r[axis]}), high = std::max({p[axis], q[axis], r[axis]});
      return std::pair(
          std::max<std::int64_t>(0, std::int64_t(std::floor((low - first[axis]) / spacing))),
          std::min<std::int64_t>(n - 1, std::int64_t(std::ceil((high - first[axis]) / spacing))));
    };
    const auto [fromX, toX] = range(0, nx);
    const auto [fromZ, toZ] = range(2, nz);
    for (std::int64_t k = fromZ; k <= toZ; ++k) {
      for (std::int64_t i = fromX; i <= toX; ++i) {
        const double x = first.x() + double(i) * spacing + shiftX,
                     z = first.z() + double(k) * spacing + shiftZ;
        const auto side = [&](const Vec3d& s, const Vec3d& t) {
          return (s.x() - x) * (t.z() - z) - (s.z() - z) * (t.x() - x);
        };
        const double u = side(q, r), v = side(r, p), w = side(p, q);
        const bool within = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
        if (!within || u + v + w == 0) continue;
        crossings[static_cast<std::size_t>(k * nx + i)].push_back((u * p.y() + v * q.y() + w * r.y()) /
                                                                  (u + v + w));
      }
    }
  }
  for (auto& column : crossings) std::sort(column.begin(), column.end());
  for (std::int64_t k = 0; k < nz; ++k) {
    for (std::int64_t j = 0; j < ny; ++j) {
      for (std::int64_t i = 0; i < nx; ++i) {
        const Vec3d center = first + spacing * Vec3d(double(i), double(j), double(k));
        const auto& column = crossings[static_cast<std::size_t>(k * nx + i)];
        const auto below = std::lower_bound(column.begin(), column.end(), center.y()) - column.begin();
        if (below % 2 == 1) out.push_back(center);
      }
    }
  }
}

}  // namespace migiwa
