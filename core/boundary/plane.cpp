#include "core/boundary/plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/boundary/plane_hits.h"

namespace migiwa {

Plane::Plane(const Vec3d& point, const Vec3d& normal) : point_(point), normal_(normal) {
  prepare();
}

template <class Visitor>
void Plane::fields(Visitor& visitor, Visited<Visitor, Plane>& self) {
  visitor.vector("point", self.point_, {"m", "A point of the wall.", Presence::required});
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

}  // namespace migiwa
