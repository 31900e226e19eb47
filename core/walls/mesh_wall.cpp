#include "core/walls/mesh_wall.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/base/progress.h"
#include "core/slim/shape_import.h"
#include "core/walls/shapes.h"

namespace migiwa {

namespace {

/// What a prepared mesh is made from.
struct MeshKey {
  FileName file;
  Transform transform;
  bool fluidInside;

  bool operator==(const MeshKey& other) const {
    return file.path == other.file.path && file.identity == other.file.identity &&
           transform == other.transform && fluidInside == other.fluidInside;
  }
};

/// What a mesh file gives, and what its import had to say.
struct PreparedMesh {
  std::shared_ptr<const TriangleTree> tree;  ///< null: the file holds points
  std::optional<BoxGeometry> box;
  std::vector<std::string> notes;
};

PreparedMesh prepareMesh(const MeshKey& key) {
  const auto& [file, transform, fluidInside] = key;
  const Activity activity("preparing the wall of " + file.path.filename().string());
  ImportedShape shape = importShape(file.path);
  requireUnchanged(file.path, file.identity);
  PreparedMesh result;
  if (!shape.isMesh()) return result;
  transformShape(shape, transform);
  result.notes = std::move(shape.notes);
  std::vector<WallTriangle> faces = wallFaces(shape.mesh, fluidInside, file.path.string());
  if (faces.empty())
    throw InputError(file.path.string(), "expected a mesh with faces, found none that bounds a solid");
  result.box = boxOf(faces);
  result.tree = std::make_shared<const TriangleTree>(std::move(faces));
  return result;
}

PreparedMesh preparedMesh(const MeshKey& key) {
  constexpr std::size_t kMostKept = 4;
  static KeptResults<MeshKey, PreparedMesh> kept(kMostKept);
  return kept.get(key, prepareMesh);
}

}  // namespace

namespace {

/// The box as a scene would name it.
Box boxWall(const BoxGeometry& box, bool fluidInside) {
  Eigen::Quaterniond turn(box.axes);
  if (turn.w() < 0) turn.coeffs() *= -1;
  const double sine = turn.vec().norm();
  Rotation rotation;
  if (sine > 1e-9)
    rotation = {turn.vec() / sine, 360 / std::numbers::pi * portable::asin(std::min(sine, 1.0))};
  return {box.center - box.halfExtents, box.center + box.halfExtents,
          fluidInside ? Box::Fluid::inside : Box::Fluid::outside, rotation};
}

}  // namespace

std::optional<BoxGeometry> boxOf(const std::vector<WallTriangle>& faces) {
  constexpr double kTolerance = 1e-6;
  struct Side {
    Vec3d normal;
    double offset;
  };
  Bounds bounds;
  for (const WallTriangle& face : faces)
    for (const Vec3f& corner : face.corners) bounds.include(corner.cast<double>());
  const double rounding = kTolerance * (bounds.size().maxCoeff() + bounds.center().cwiseAbs().maxCoeff());
  std::vector<Side> sides;
  double area = 0;
  for (const WallTriangle& face : faces) {
    if (face.sheet) return std::nullopt;
    const Vec3d a = face.corners[0].cast<double>();
    const Vec3d across = (face.corners[1].cast<double>() - a).cross(face.corners[2].cast<double>() - a);
    area += 0.5 * across.norm();
    const Vec3d normal = across.normalized();
    const bool known = std::any_of(sides.begin(), sides.end(), [&](const Side& side) {
      return side.normal.dot(normal) > 0 &&
             std::all_of(face.corners.begin(), face.corners.end(), [&](const Vec3f& p) {
               return std::abs(side.normal.dot(p.cast<double>()) - side.offset) <= rounding;
             });
    });
    if (!known) sides.push_back({normal, normal.dot(a)});
    if (sides.size() > 6) return std::nullopt;
  }
  if (sides.size() != 6) return std::nullopt;
  // Three pairs that face each other, at right angles.
  BoxGeometry box;
  box.center.setZero();
  int axes = 0;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      const double cosine = sides[k].normal.dot(sides[l].normal);
      if (std::abs(cosine) <= kTolerance) continue;
      if (cosine > kTolerance - 1 || axes == 3) return std::nullopt;
      const Vec3d axis = sides[l].normal;
      box.axes.col(axes) = axis;
      box.halfExtents[axes] = 0.5 * std::abs(sides[l].offset + sides[k].offset);
      box.center += 0.5 * (sides[l].offset - sides[k].offset) * axis;
      ++axes;
    }
  }
  if (axes != 3) return std::nullopt;
  // In the order of the coordinates, so that one along them is the box that a scene would name.
  for (int column = 0; column < 3; ++column) {
    int best = column;
    for (int other = column + 1; other < 3; ++other)
      if (std::abs(box.axes(column, other)) > std::abs(box.axes(column, best))) best = other;
    box.axes.col(column).swap(box.axes.col(best));
    std::swap(box.halfExtents[column], box.halfExtents[best]);
    if (box.axes(column, column) < 0) box.axes.col(column) *= -1;
  }
  if (box.axes.determinant() < 0) box.axes.col(2) *= -1;
  // Six planes are a box if all of each is there, and nothing twice.
  const Vec3d e = 2 * box.halfExtents;
  const double whole = 2 * (e.x() * e.y() + e.y() * e.z() + e.z() * e.x());
  if (std::abs(area - whole) > 10 * rounding * e.sum()) return std::nullopt;
  return box;
}

template <class Visitor>
void MeshSurface::fields(Visitor& visitor, Visited<Visitor, MeshSurface>& self) {
  visitor.choice(
      "fluid", self.fluid_, kFluidNames,
      {"", "The side of the wall that holds the fluid; parts of a mesh that are open have it on both.",
       Presence::required});
  visitor.file("file", self.file_,
               {"",
                "OBJ, PLY, STL, ...: triangles, taken as they are, or points, which are fitted as slim does. "
                "Relative to the scene file.",
                Presence::required});
  Transform::describe(visitor, self.transform_);
}

void MeshSurface::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void MeshSurface::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  if (visitor.valid({"file", "transform"})) prepare(visitor);
}

void MeshSurface::prepare(FieldVisitor& visitor) {
  const bool inside = fluid_ == Fluid::inside;
  try {
    const PreparedMesh mesh = preparedMesh({file_, transform_, inside});
    std::vector<std::string> notes = mesh.notes;
    if (mesh.box) {
      shape_ = std::make_shared<const Box>(boxWall(*mesh.box, inside));
    } else if (mesh.tree != nullptr) {
      shape_ = std::make_shared<const TriangleWall>(mesh.tree, inside);
    } else {
      auto fitted = std::make_shared<const SlimSurface>(
          file_, transform_, inside ? SlimSurface::Fluid::inside : SlimSurface::Fluid::outside);
      notes = fitted->notes();
      shape_ = std::move(fitted);
    }
    for (const std::string& note : notes) visitor.warning("file", file_.path.string() + ": " + note);
  } catch (const InputError& error) {
    for (const Fault& fault : error.faults()) visitor.fault("file", fault.message + " (" + fault.place + ")");
  }
}

std::shared_ptr<const Surface> standFor(const Surface& wall, const std::optional<Motion>& motion,
                                        float supportRadius) {
  const auto moving = [&motion](auto made) -> std::shared_ptr<const Surface> {
    made->motion = motion;
    return made;
  };
  if (const auto* triangles = dynamic_cast<const TriangleWall*>(&wall))
    return moving(std::make_shared<TriangleWall>(triangles->tree(), triangles->vessel(), supportRadius));
  if (const auto* box = dynamic_cast<const Box*>(&wall)) return moving(std::make_shared<Box>(*box));
  return moving(std::make_shared<SlimSurface>(dynamic_cast<const SlimSurface&>(wall)));
}

std::shared_ptr<const Surface> MeshSurface::forSupport(float supportRadius) const {
  return standFor(*shape_, motion, supportRadius);
}

}  // namespace migiwa
