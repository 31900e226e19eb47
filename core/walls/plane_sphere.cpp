#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "core/base/math.h"
#include "core/walls/shapes.h"
#include "core/walls/surface.h"

namespace migiwa {

Plane::Plane(const Vec3d& point, const Vec3d& normal) : point_(point), normal_(normal) {
  prepare();
}

template <class Visitor>
void Plane::fields(Visitor& visitor, Visited<Visitor, Plane>& self) {
  visitor.place("point", self.point_, {"m", "A point of the wall.", Presence::required});
  visitor.vector("normal", self.normal_,
                 {"1", "Points into the fluid; any length but zero.", Presence::required});
}

void Plane::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void Plane::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  if (normal_.norm() > 1e-12) {
    prepare();
  } else {
    visitor.fault("normal", "expected a vector that is not zero, found [0, 0, 0]");
  }
}

void Plane::prepare() {
  const Vec3d unit = normal_.normalized();
  unit_ = unit.cast<float>();
  offset_ = static_cast<float>(unit.dot(point_));
}

float Plane::distance(const Vec3f& p, Vec3f& normal) const {
  normal = unit_;
  return unit_.dot(p) - offset_;
}

bool Plane::project(Vec3f& p, float margin) const {
  const float missing = margin - (unit_.dot(p) - offset_);
  if (missing <= 0) return false;
  p += missing * unit_;
  return true;
}

void Plane::pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const {
  const float d = unit_.dot(p) - offset_;
  if (std::abs(d) < reach) out.push_back({unit_, d, p - d * unit_});
}

std::optional<ClosedForm> Plane::closedForm() const {
  const Vec3d normal = normal_.normalized(), across = normal.unitOrthogonal();
  ClosedForm form{.kind = ClosedForm::Kind::plane, .center = point_};
  form.axes << across, normal.cross(across), normal;
  return form;
}

void Plane::firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const {
  hitPlane(unit_, unit_.dot(origin) - offset_, directions, hits);
}

void Plane::wireframe(const Bounds& scene, std::vector<LineSegment>& out) const {
  // A square around the scene's shadow on the plane, with a few lines across.
  const Vec3d unit = unit_.cast<double>();
  const Vec3d across = unit.unitOrthogonal();
  const Vec3d along = unit.cross(across);
  const Vec3d center = scene.center() - (unit.dot(scene.center()) - static_cast<double>(offset_)) * unit;
  const double half = 0.6 * std::max(scene.size().norm(), 1e-6);
  constexpr int kCells = 4;
  for (int k = 0; k <= kCells; ++k) {
    const double at = half * (2.0 * k / kCells - 1);
    out.push_back({(center + at * across - half * along).cast<float>(),
                   (center + at * across + half * along).cast<float>()});
    out.push_back({(center + at * along - half * across).cast<float>(),
                   (center + at * along + half * across).cast<float>()});
  }
}

Sphere::Sphere(const Vec3d& center, double radius, Fluid fluid)
    : centerExact_(center), radiusExact_(radius), fluid_(fluid) {
  prepare();
}

template <class Visitor>
void Sphere::fields(Visitor& visitor, Visited<Visitor, Sphere>& self) {
  visitor.choice("fluid", self.fluid_, kFluidNames,
                 {"", "The side of the wall that holds the fluid.", Presence::required});
  visitor.place("center", self.centerExact_, {"m", "Centre.", Presence::required});
  visitor.number("radius", self.radiusExact_, Range::length(kLargestCoordinate),
                 {"m", "Radius.", Presence::required});
}

void Sphere::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void Sphere::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  prepare();
}

void Sphere::prepare() {
  center_ = centerExact_.cast<float>();
  radius_ = static_cast<float>(radiusExact_);
}

float Sphere::distance(const Vec3f& p, Vec3f& normal) const {
  const Vec3f offset = p - center_;
  const float length = offset.norm();
  const Vec3f outward = length > 0 ? Vec3f(offset / length) : Vec3f(Vec3f::UnitY());
  normal = fluid_ == Fluid::inside ? Vec3f(-outward) : outward;
  return fluid_ == Fluid::inside ? radius_ - length : length - radius_;
}

bool Sphere::project(Vec3f& p, float margin) const {
  Vec3f normal;
  const float missing = margin - distance(p, normal);
  if (missing <= 0) return false;
  // Inside, the centre is as far as one can get: where the margin leaves no room it is midway.
  const float room = fluid_ == Fluid::inside ? (p - center_).norm() : missing;
  p += std::min(missing, room) * normal;
  return true;
}

void Sphere::firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const {
  // |o + t w|^2 = R^2 with o relative to the centre. From inside the far root, from outside the near one,
  // written so that neither cancels: their product is c, and -b +- root has no cancellation on the side that
  // is asked for.
  const Vec3f o = origin - center_;
  const float length = o.norm();
  const float c = (length - radius_) * (length + radius_);
  const bool inside = fluid_ == Fluid::inside;
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const float b = o.x() * directions.x[k] + o.y() * directions.y[k] + o.z() * directions.z[k];
    const float discriminant = b * b - c;
    const float root = std::sqrt(std::max(discriminant, 0.0F));
    float hit;
    if (inside) {
      hit = b > 0 ? -c / (b + root) : root - b;
    } else {
      hit = discriminant > 0 && b < 0 ? c / (root - b) : hits[k];
    }
    hits[k] = std::min(hits[k], std::max(hit, 0.0F));
  }
}

void Sphere::exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const {
  const Vec3f o = origin - center_;
  const float length = o.norm();
  const float c = (length - radius_) * (length + radius_);
  for (std::size_t k = 0; k < exits.size(); ++k) {
    const float b = o.x() * directions.x[k] + o.y() * directions.y[k] + o.z() * directions.z[k];
    exits[k] = std::sqrt(std::max(b * b - c, 0.0F)) - b;
  }
}

float Sphere::thickness() const {
  return fluid_ == Fluid::outside ? 2 * radius_ : Surface::thickness();
}

bool Sphere::crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const {
  if (fluid_ == Fluid::inside) return false;
  // a t^2 + 2 b t + c = 0 along the way; the roots as in firstHits.
  const Vec3f start = from - center_, way = to - from;
  const float a = way.squaredNorm(), b = start.dot(way), length = start.norm();
  const float c = (length - radius_) * (length + radius_);
  const float discriminant = b * b - a * c;
  if (discriminant <= 0 || a == 0) return false;
  const float root = std::sqrt(discriminant);
  const float enter = b < 0 ? c / (root - b) : -(root + b) / a,
              leave = b < 0 ? (root - b) / a : -c / (root + b);
  entry = std::max(enter, 0.0F);
  if (entry >= std::min(leave, 1.0F)) return false;
  normal = (start + entry * way).normalized();
  return true;
}

bool Sphere::enclosed(TriangleMesh& mesh) const {
  // From pole to pole: with a step of pi / 64 the middles of triangles lie 3e-4 of the radius inside.
  constexpr std::uint32_t kRings = 64, kAround = 2 * kRings;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto at = [first](std::uint32_t ring, std::uint32_t k) {
    if (ring == 0) return first;
    return ring == kRings ? first + 1 : first + 2 + (ring - 1) * kAround + k % kAround;
  };
  const auto vertex = [&](double down, double turn) {
    const Vec3d unit(portable::sin(down) * portable::sin(turn), portable::cos(down),
                     portable::sin(down) * portable::cos(turn));
    mesh.vertices.emplace_back((centerExact_ + radiusExact_ * unit).cast<float>());
  };
  vertex(0, 0);
  vertex(std::numbers::pi, 0);
  for (std::uint32_t ring = 1; ring < kRings; ++ring)
    for (std::uint32_t k = 0; k < kAround; ++k)
      vertex(std::numbers::pi * ring / kRings, 2 * std::numbers::pi * k / kAround);
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    for (std::uint32_t k = 0; k < kAround; ++k) {
      if (ring > 0) mesh.triangles.push_back({at(ring, k), at(ring + 1, k), at(ring, k + 1)});
      if (ring + 1 < kRings)
        mesh.triangles.push_back({at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)});
    }
  }
  return true;
}

std::optional<ClosedForm> Sphere::closedForm() const {
  return ClosedForm{.kind = ClosedForm::Kind::sphere,
                    .center = centerExact_,
                    .halfExtents = Vec3d::Constant(radiusExact_),
                    .fluidInside = fluid_ == Fluid::inside};
}

Bounds Sphere::bounds() const {
  Bounds bounds;
  bounds.include(centerExact_);
  return bounds.grown(radiusExact_);
}

void Sphere::wireframe(const Bounds&, std::vector<LineSegment>& out) const {
  // Three great circles and two small ones on each side of the equator.
  constexpr int kSegments = 64;
  const auto circle = [&](const Vec3d& center, const Vec3d& u, const Vec3d& v, double radius) {
    Vec3d from = center + radius * u;
    for (int k = 1; k <= kSegments; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSegments;
      const Vec3d to = center + radius * (portable::cos(angle) * u + portable::sin(angle) * v);
      out.push_back({from.cast<float>(), to.cast<float>()});
      from = to;
    }
  };
  const Vec3d x = Vec3d::UnitX(), y = Vec3d::UnitY(), z = Vec3d::UnitZ();
  circle(centerExact_, x, y, radiusExact_);
  circle(centerExact_, z, y, radiusExact_);
  for (const double latitude : {-60.0, -30.0, 0.0, 30.0, 60.0}) {
    const double angle = latitude * std::numbers::pi / 180;
    circle(centerExact_ + radiusExact_ * portable::sin(angle) * y, x, z, radiusExact_ * portable::cos(angle));
  }
}

}  // namespace migiwa
