#include "core/scene/sphere_source.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace migiwa {

template <class Visitor>
void SphereSource::fields(Visitor& visitor, Visited<Visitor, SphereSource>& self) {
  visitor.vector("center", self.center_, {"m", "Centre of the ball.", Presence::required});
  visitor.number("radius", self.radius_, Range::length(kLargestCoordinate),
                 {"m", "Its radius.", Presence::required});
}

void SphereSource::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void SphereSource::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
}

double SphereSource::count(double spacing) const {
  // A cell whose centre is in the ball lies in a ball that is larger by half a cell's diagonal.
  const double reach = radius_ / spacing + 0.5 * std::numbers::sqrt3;
  const double cells = std::round(2 * radius_ / spacing);
  return std::min(cells * cells * cells, std::floor(4.0 / 3 * std::numbers::pi * reach * reach * reach));
}

void SphereSource::fill(double spacing, std::vector<Vec3d>& out) const {
  const auto n = static_cast<std::int64_t>(std::round(2 * radius_ / spacing));
  const double first = -0.5 * double(n - 1) * spacing;
  for (std::int64_t k = 0; k < n; ++k) {
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t i = 0; i < n; ++i) {
        const Vec3d offset(first + double(i) * spacing, first + double(j) * spacing,
                           first + double(k) * spacing);
        if (offset.squaredNorm() <= radius_ * radius_) out.push_back(center_ + offset);
      }
    }
  }
}

Bounds SphereSource::bounds() const {
  Bounds bounds;
  bounds.include(center_ - Vec3d::Constant(radius_));
  bounds.include(center_ + Vec3d::Constant(radius_));
  return bounds;
}

}  // namespace migiwa
