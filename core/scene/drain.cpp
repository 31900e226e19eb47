#include "core/scene/drain.h"

#include <algorithm>
#include <sstream>
#include <string>

#include <Eigen/Geometry>

namespace migiwa {

namespace {

constexpr FieldDoc kRegionDoc{"", "Of the region.", Presence::required};

}  // namespace

template <class Visitor>
void Drain::fields(Visitor& visitor, Visited<Visitor, Drain>& self) {
  if (self.shape == DrainShape::box) {
    visitor.place("min", self.min,
                  {"m", "Corner with the smallest coordinates, before the rotation.", Presence::required});
    visitor.place("max", self.max,
                  {"m", "Corner with the largest coordinates, before the rotation.", Presence::required});
    visitor.object("rotation", {"", "Turns the box about its centre."},
                   [&](auto& turn) { Rotation::describe(turn, self.rotation); });
  } else {
    visitor.place("center", self.center, {"m", "Centre of the ball.", Presence::required});
    visitor.number("radius", self.radius, Range::length(kLargestCoordinate),
                   {"m", "Its radius.", Presence::required});
  }
  visitor.number("start", self.start, Range::closed(0, 1e6), {"s", "When it opens."});
  visitor.number("stop", self.stop, Range::closed(0, 1e6), {"s", "When it closes."});
}

void Drain::describe(FieldWriter& visitor) const {
  describeShaped(visitor, shape, kDrainShapeNames, kRegionDoc,
                 [this](FieldWriter& region) { fields(region, *this); });
}

void Drain::describe(FieldVisitor& visitor, double spacing) {
  describeShaped(visitor, shape, kDrainShapeNames, kRegionDoc, [&](FieldVisitor& region) {
    fields(region, *this);
    check(region, spacing);
  });
}

void Drain::check(FieldVisitor& visitor, double spacing) {
  const bool box = shape == DrainShape::box;
  if (box && visitor.valid({"min", "max"}) && (max.array() <= min.array()).any()) {
    visitor.fault("max", "expected every coordinate to be larger than that of min, found one that is not");
    max = min + Vec3d::Ones();
  }
  if (visitor.valid({"start", "stop"}) && stop <= start)
    visitor.fault("stop", "expected a time after start, found an earlier one");
  if (spacing <= 0 || !visitor.valid({"min", "max", "radius"})) return;
  // Quotients of decimal numbers miss whole ones by what a double cannot hold.
  const double thickness = box ? (max - min).minCoeff() : 2 * radius;
  if (thickness >= spacing * (1 - 1e-9)) return;
  std::ostringstream text;
  text << "expected a region at least one particle_spacing thick, which is " << spacing << " m, found "
       << thickness << " m; particles would pass through it within a step";
  visitor.fault("", text.str());
}

DrainRegion::DrainRegion(const Drain& drain)
    : sphere_(drain.shape == DrainShape::sphere),
      center_(sphere_ ? drain.center : Vec3d(0.5 * (drain.min + drain.max))),
      half_(sphere_ ? Vec3d(Vec3d::Constant(drain.radius)) : Vec3d(0.5 * (drain.max - drain.min))),
      axes_(sphere_ ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : drain.rotation.matrix()) {}

bool DrainRegion::within(const Vec3d& p, double distance) const {
  const Vec3d offset = p - center_;
  const Vec3d reach = half_.array() + distance;
  if (sphere_) return offset.squaredNorm() <= reach.x() * reach.x();
  return ((axes_.transpose() * offset).array().abs() <= reach.array()).all();
}

Bounds DrainRegion::bounds() const {
  const Vec3d reach = axes_.cwiseAbs() * half_;
  Bounds bounds;
  bounds.min = center_ - reach, bounds.max = center_ + reach;
  return bounds;
}

}  // namespace migiwa
