#include "app/raytrace/bodies.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace migiwa {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

ConvexSolid::Stretch nowhere() {
  return {kNever, -kNever, Vec3f::UnitY(), Vec3f::UnitY()};
}

}  // namespace

ConvexSolid::ConvexSolid(const ClosedForm& form)
    : kind_(form.kind),
      center_(form.center.cast<float>()),
      half_(form.halfExtents.cast<float>()),
      toLocal_(form.axes.transpose().cast<float>()),
      toWorld_(form.axes.cast<float>()) {}

ConvexSolid::Stretch ConvexSolid::boxStretch(const Vec3f& origin, const Vec3f& direction) const {
  const Vec3f o = toLocal_ * (origin - center_), d = toLocal_ * direction;
  float from = -kNever, to = kNever;
  Eigen::Index entry = 0, exit = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0) {
      if (std::abs(o[axis]) > half_[axis]) return nowhere();
      continue;
    }
    const float inverse = 1 / d[axis], side = std::copysign(half_[axis], d[axis]);
    const float in = (-side - o[axis]) * inverse, out = (side - o[axis]) * inverse;
    if (in > from) from = in, entry = axis;
    if (out < to) to = out, exit = axis;
  }
  return {from, to, Vec3f(toWorld_.col(entry) * (d[entry] > 0 ? -1.0F : 1.0F)),
          Vec3f(toWorld_.col(exit) * (d[exit] > 0 ? 1.0F : -1.0F))};
}

ConvexSolid::Stretch ConvexSolid::ballStretch(const Vec3f& origin, const Vec3f& direction) const {
  const Vec3f o = origin - center_;
  const float radius = half_.x(), b = o.dot(direction);
  // The nearest point of the ray tells without cancellation how deep it goes.
  const float miss2 = (o - b * direction).squaredNorm();
  const float discriminant = radius * radius - miss2;
  if (discriminant <= 0) return nowhere();
  const float root = std::sqrt(discriminant), length = o.norm();
  const float c = (length - radius) * (length + radius);
  const float from = b > 0 ? -b - root : c / (root - b), to = b > 0 ? -c / (b + root) : root - b;
  return {from, to, (o + from * direction).normalized(), (o + to * direction).normalized()};
}

ConvexSolid::Stretch ConvexSolid::stretch(const Vec3f& origin, const Vec3f& direction) const {
  if (kind_ == ClosedForm::Kind::box) return boxStretch(origin, direction);
  if (kind_ == ClosedForm::Kind::sphere) return ballStretch(origin, direction);
  const Vec3f normal = toWorld_.col(2);
  const float height = normal.dot(origin - center_), along = normal.dot(direction);
  if (along == 0) return height > 0 ? nowhere() : Stretch{-kNever, kNever, normal, normal};
  const float at = -height / along;
  return along < 0 ? Stretch{at, kNever, normal, normal} : Stretch{-kNever, at, normal, normal};
}

bool ConvexSolid::contains(const Vec3f& p) const {
  const Vec3f local = toLocal_ * (p - center_);
  if (kind_ == ClosedForm::Kind::box) return ((local.cwiseAbs() - half_).array() <= 0).all();
  if (kind_ == ClosedForm::Kind::sphere) return local.norm() <= half_.x();
  return local.z() <= 0;
}

std::optional<Body> Body::around(const Surface& surface, bool glass, float thickness, const Vec3f& up) {
  Body body;
  body.glass_ = glass;
  body.thickness_ = thickness;
  if (const std::optional<ClosedForm> form = surface.closedForm()) {
    if (!form->fluidInside) {
      body.outer_.emplace(*form);
      return body;
    }
    ClosedForm outer = *form, cavity = *form;
    outer.halfExtents += Vec3d::Constant(static_cast<double>(thickness));
    if (form->kind == ClosedForm::Kind::box) {
      // The cavity pierces the side of the shell that is most upwards.
      Eigen::Index top = 0;
      const Vec3d along = form->axes.transpose() * up.cast<double>();
      along.cwiseAbs().maxCoeff(&top);
      const double more = 2 * static_cast<double>(thickness);
      cavity.halfExtents[top] += more;
      cavity.center += form->axes.col(top) * (along[top] > 0 ? more : -more);
    }
    body.cavity_.emplace(cavity);
    if (glass) {
      body.outer_.emplace(outer);
    } else {
      body.hollow_ = true;
    }
    return body;
  }
  const WallMesh mesh = surface.mesh();
  if (mesh.surface.triangles.empty()) return std::nullopt;
  body.surface_ = &surface;
  body.setMesh(mesh, thickness);
  return body;
}

Body Body::ground(const Vec3f& point, const Vec3f& up) {
  ClosedForm form{.kind = ClosedForm::Kind::plane, .center = point.cast<double>()};
  const Vec3d normal = up.cast<double>(), across = normal.unitOrthogonal();
  form.axes << across, normal.cross(across), normal;
  Body body;
  body.outer_.emplace(form);
  return body;
}

void Body::setMesh(const WallMesh& mesh, float thickness) {
  vessel_ = mesh.vessel;
  TriangleMesh surface = mesh.surface;
  normals_ = mesh.normals;
  if (vessel_ && glass_) {
    const auto count = static_cast<std::uint32_t>(surface.vertices.size());
    for (std::uint32_t k = 0; k < count; ++k) {
      surface.vertices.emplace_back(surface.vertices[k] - thickness * mesh.normals[k]);
      normals_.emplace_back(-mesh.normals[k]);
    }
    for (const auto& [a, b, c] : mesh.surface.triangles)
      surface.triangles.push_back({a + count, c + count, b + count});
  }
  facingFluid_ = mesh.surface.triangles.size();
  triangles_ = surface.triangles;
  rays_ = TriangleRays(surface);
}

Body::Stretches Body::stretches(const Vec3f& origin, const Vec3f& direction) const {
  Stretches result;
  const auto add = [&](const ConvexSolid::Stretch& inside, bool entersOutside, bool leavesOutside) {
    if (inside.from < inside.to)
      result.part[static_cast<std::size_t>(result.count++)] = {inside, entersOutside, leavesOutside};
  };
  const bool shell = cavity_.has_value();
  const ConvexSolid::Stretch whole =
      hollow_ ? ConvexSolid::Stretch{-kNever, kNever, Vec3f::UnitY(), Vec3f::UnitY()}
              : outer_->stretch(origin, direction);
  if (whole.from >= whole.to) return result;
  const ConvexSolid::Stretch hole = shell ? cavity_->stretch(origin, direction) : nowhere();
  if (hole.from >= hole.to || hole.from >= whole.to || hole.to <= whole.from) {
    add(whole, shell, shell);
    return result;
  }
  add({whole.from, hole.from, whole.entry, Vec3f(-hole.entry)}, true, false);
  add({hole.to, whole.to, Vec3f(-hole.exit), whole.exit}, false, true);
  return result;
}

bool Body::facing(const Vec3f& origin, const Vec3f& direction, float side, BodyHit& hit) const {
  float from = 0;
  TriangleRays::Hit found;
  while (rays_.first(origin, direction, from, hit.distance, found)) {
    if (side * direction.dot(found.normal) > 0) {
      hit.distance = found.distance;
      hit.normal = found.normal;
      const auto& [a, b, c] = triangles_[found.triangle];
      hit.shading = ((1 - found.u - found.v) * normals_[a] + found.u * normals_[b] + found.v * normals_[c])
                        .normalized();
      hit.outside = found.triangle >= facingFluid_;
      return true;
    }
    from = std::nextafter(found.distance, kNever);
  }
  return false;
}

bool Body::enter(const Vec3f& origin, const Vec3f& direction, BodyHit& hit) const {
  if (meshed()) return facing(origin, direction, -1, hit);
  const Stretches inside = stretches(origin, direction);
  for (int k = 0; k < inside.count; ++k) {
    const Part& part = inside.part[static_cast<std::size_t>(k)];
    if (!(part.inside.from > 0 && part.inside.from < hit.distance)) continue;
    hit.distance = part.inside.from;
    hit.normal = hit.shading = part.inside.entry;
    hit.outside = part.entersOutside;
    return true;
  }
  return false;
}

bool Body::blocks(const Vec3f& origin, const Vec3f& direction, float distance) const {
  BodyHit hit;
  hit.distance = distance;
  return enter(origin, direction, hit);
}

bool Body::leave(const Vec3f& origin, const Vec3f& direction, BodyHit& hit) const {
  hit.distance = kNever;
  if (meshed()) return facing(origin, direction, 1, hit);
  const Stretches inside = stretches(origin, direction);
  // Where rounding has put the origin outside, the ray has left already.
  hit.normal = direction;
  for (int k = 0; k < inside.count; ++k) {
    const Part& part = inside.part[static_cast<std::size_t>(k)];
    if (part.inside.from > 1e-3F * thickness_) break;
    hit.normal = hit.shading = part.inside.exit;
    hit.outside = part.leavesOutside;
    if (part.inside.to <= 0) continue;
    hit.distance = part.inside.to;
    return part.inside.to < kNever;
  }
  hit.distance = 0;
  hit.shading = hit.normal;
  return true;
}

bool Body::contains(const Vec3f& p) const {
  if (meshed()) {
    Vec3f ignored;
    const float distance = surface_->distance(p, ignored);
    return distance < 0 && (!vessel_ || !glass_ || distance > -thickness_);
  }
  if (cavity_ && cavity_->contains(p)) return false;
  return hollow_ || outer_->contains(p);
}

}  // namespace migiwa
