#include "core/scene/box_source.h"

#include <cmath>

namespace migiwa {

BoxSource::BoxSource(const Vec3d& min, const Vec3d& max, const Rotation& rotation)
    : min_(min), max_(max), rotation_(rotation) {}

template <class Visitor>
void BoxSource::fields(Visitor& visitor, Visited<Visitor, BoxSource>& self) {
  visitor.vector("min", self.min_,
                 {"m", "Corner with the smallest coordinates, before the rotation.", Presence::required});
  visitor.vector("max", self.max_,
                 {"m", "Corner with the largest coordinates, before the rotation.", Presence::required});
  visitor.object("rotation", {"", "Turns the box about its centre."},
                 [&](auto& rotation) { Rotation::describe(rotation, self.rotation_); });
}

void BoxSource::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void BoxSource::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  if (visitor.sound({"min", "max"}) && (max_.array() <= min_.array()).any())
    visitor.fault("max", "expected every coordinate to be larger than that of min, found one that is not");
}

Vec3d BoxSource::cells(double spacing) const {
  return ((max_ - min_) / spacing).array().unaryExpr([](double n) { return std::round(n); });
}

double BoxSource::count(double spacing) const {
  return cells(spacing).prod();
}

Vec3d BoxSource::toWorld(const Vec3d& p) const {
  if (rotation_.degrees == 0) return p;  // exact for the upright box
  const Vec3d center = 0.5 * (min_ + max_);
  return center + rotation_.matrix() * (p - center);
}

void BoxSource::fill(double spacing, std::vector<Vec3d>& out) const {
  const Eigen::Array<std::int64_t, 3, 1> n = cells(spacing).array().cast<std::int64_t>();
  for (std::int64_t k = 0; k < n.z(); ++k)
    for (std::int64_t j = 0; j < n.y(); ++j)
      for (std::int64_t i = 0; i < n.x(); ++i)
        out.push_back(
            toWorld(min_ + spacing * (Eigen::Array3d(double(i), double(j), double(k)) + 0.5).matrix()));
}

Bounds BoxSource::bounds() const {
  Bounds bounds;
  for (int corner = 0; corner < 8; ++corner)
    bounds.include(toWorld({(corner & 1) != 0 ? max_.x() : min_.x(), (corner & 2) != 0 ? max_.y() : min_.y(),
                            (corner & 4) != 0 ? max_.z() : min_.z()}));
  return bounds;
}

}  // namespace migiwa
