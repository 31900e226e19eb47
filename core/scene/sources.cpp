#include "core/scene/sources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/base/fields.h"
#include "core/base/messages.h"
#include "core/slim/fit.h"

namespace migiwa {

namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<FluidSource> (*make)();
};

template <class Source>
std::unique_ptr<FluidSource> make() {
  return std::make_unique<Source>();
}

constexpr std::array kSources{
    Entry{"box", make<BoxSource>},
    Entry{"sphere", make<SphereSource>},
    Entry{"mesh", make<MeshSource>},
    Entry{"wave", make<WaveSource>},
};

}  // namespace

std::span<const std::string_view> fluidShapes() {
  return registryNames<kSources>();
}

std::unique_ptr<FluidSource> makeFluidSource(int shape) {
  return kSources.at(static_cast<std::size_t>(shape)).make();
}

namespace {

constexpr double kRadians = std::numbers::pi / 180;

template <class Visitor>
void describeVelocityWave(Visitor& visitor, Visited<Visitor, VelocityWave>& wave) {
  if constexpr (Visitor::kChanges) wave.point = Vec3d::Zero() - visitor.origin();
  visitor.vector("velocity", wave.velocity, {"m/s", "On a crest.", Presence::required});
  visitor.vector("wave", wave.wave,
                 {"1/m", "Wave vector: 2 pi over the wavelength, across the crests.", Presence::required});
  visitor.place("point", wave.point, {"m", "On a crest."});
}

}  // namespace

template <class Visitor>
void FluidSource::describeMotion(Visitor& visitor, Visited<Visitor, FluidSource>& self) {
  visitor.vector("velocity", self.velocity, {"m/s", "Velocity at the start."});
  visitor.object(
      "angular_velocity", {"", "A rigid turn at the start, added to the velocity."},
      [&](auto& fields) {
        if constexpr (Visitor::kChanges) self.spin.point = Vec3d::Zero() - fields.origin();
        fields.vector("axis", self.spin.axis, {"1", "Any length but zero.", Presence::required});
        fields.place("point", self.spin.point, {"m", "On the axis."});
        fields.number("degrees_per_second", self.spin.degreesPerSecond, Range::closed(-1e6, 1e6),
                      {"degrees/s", "Right-handed.", Presence::required});
        if (fields.valid({"axis"}) && self.spin.axis.norm() < 1e-12)
          fields.fault("axis", "expected a vector that is not zero, found [0, 0, 0]");
      },
      &self.spin.given);
  visitor.list(
      "velocity_waves", self.velocityWaves.size(),
      {"", "Waves of the velocity at the start, velocity * cos(wave . (x - point)), added to the velocity."},
      [&](auto& fields, std::size_t at) {
        if constexpr (Visitor::kChanges)
          if (at >= self.velocityWaves.size()) self.velocityWaves.emplace_back();
        describeVelocityWave(fields, self.velocityWaves[at]);
      });
}
template void FluidSource::describeMotion<FieldVisitor>(FieldVisitor&, FluidSource&);
template void FluidSource::describeMotion<FieldWriter>(FieldWriter&, const FluidSource&);

Vec3d FluidSource::velocityAt(const Vec3d& p) const {
  Vec3d sum = velocity + ownVelocity(p);
  if (spin.given) sum += kRadians * spin.degreesPerSecond * spin.axis.normalized().cross(p - spin.point);
  for (const VelocityWave& own : velocityWaves)
    sum += portable::cos(own.wave.dot(p - own.point)) * own.velocity;
  return sum;
}

double FluidSource::largestSpeed() const {
  double speed = velocity.norm() + ownSpeed();
  for (const VelocityWave& own : velocityWaves) speed += own.velocity.norm();
  if (const Bounds all = bounds(); spin.given && !all.empty()) {
    const Vec3d farthest = (all.center() - spin.point).cwiseAbs() + 0.5 * all.size();
    speed += kRadians * std::abs(spin.degreesPerSecond) * farthest.norm();
  }
  return speed;
}

BoxSource::BoxSource(const Vec3d& min, const Vec3d& max, const Rotation& rotation)
    : min_(min), max_(max), rotation_(rotation) {}

template <class Visitor>
void BoxSource::fields(Visitor& visitor, Visited<Visitor, BoxSource>& self) {
  visitor.place("min", self.min_,
                {"m", "Corner with the smallest coordinates, before the rotation.", Presence::required});
  visitor.place("max", self.max_,
                {"m", "Corner with the largest coordinates, before the rotation.", Presence::required});
  visitor.object("rotation", {"", "Turns the box about its centre."},
                 [&](auto& rotation) { Rotation::describe(rotation, self.rotation_); });
}

void BoxSource::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void BoxSource::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  if (visitor.valid({"min", "max"}) && (max_.array() <= min_.array()).any())
    visitor.fault("max", "expected every coordinate to be larger than that of min, found one that is not");
}

double BoxSource::count(double spacing) const {
  // One that goes on from another box may have a cell more than has room in it.
  const Eigen::Array3d cells = (max_ - min_).array() / spacing;
  return (cells < 0.5).any() ? 0 : (cells - kCellTolerance).ceil().prod();
}

Vec3d BoxSource::toWorld(const Vec3d& p) const {
  if (rotation_.degrees == 0) return p;  // exact for the upright box
  const Vec3d center = 0.5 * (min_ + max_);
  return center + rotation_.matrix() * (p - center);
}

void BoxSource::fill(double spacing, std::vector<Vec3d>& out) const {
  std::array<std::int64_t, 3> n{};
  for (int axis = 0; axis < 3; ++axis)
    n[static_cast<std::size_t>(axis)] =
        static_cast<std::int64_t>(wholeCells(max_[axis] - min_[axis], spacing));
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i)
        out.push_back(
            toWorld(min_ + spacing * (Eigen::Array3d(double(i), double(j), double(k)) + 0.5).matrix()));
}

Bounds BoxSource::block() const {
  return rotation_.degrees == 0 ? Bounds{min_, max_} : Bounds{};
}

Vec3d BoxSource::leftOver(double spacing) const {
  return (max_ - min_).unaryExpr([=](double length) {
    return std::max(0.0, length - spacing * wholeCells(length, spacing));
  });
}

Bounds BoxSource::bounds() const {
  Bounds bounds;
  for (int corner = 0; corner < 8; ++corner)
    bounds.include(toWorld({(corner & 1) != 0 ? max_.x() : min_.x(), (corner & 2) != 0 ? max_.y() : min_.y(),
                            (corner & 4) != 0 ? max_.z() : min_.z()}));
  return bounds;
}

template <class Visitor>
void SphereSource::fields(Visitor& visitor, Visited<Visitor, SphereSource>& self) {
  visitor.place("center", self.center_, {"m", "Centre of the ball.", Presence::required});
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
        if (offset.squaredNorm() <= radius_ * radius_) out.emplace_back(center_ + offset);
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

MeshSource::MeshSource(TriangleMesh mesh) : mesh_(std::move(mesh)) {
  measure();
}

template <class Visitor>
void MeshSource::fields(Visitor& visitor, Visited<Visitor, MeshSource>& self) {
  visitor.file("file", self.file_,
               {"", "OBJ, PLY, STL, ...: a closed mesh. Relative to the scene file.", Presence::required});
  Transform::describe(visitor, self.transform_);
}

void MeshSource::describe(FieldWriter& visitor) const {
  fields(visitor, *this);
}

void MeshSource::describe(FieldVisitor& visitor) {
  fields(visitor, *this);
  if (!visitor.valid({"file", "transform"})) return;
  try {
    ImportedShape shape = importShape(file_.path);
    requireUnchanged(file_.path, file_.identity);
    if (!shape.isMesh() || !shape.closed) {
      std::string found = "points alone, of which a mesh program makes a mesh";
      if (shape.branching) {
        found = "one that encloses nothing there: " + shape.branching->message;
      } else if (shape.isMesh()) {
        found = "one that is open: " + shape.rim + "; fill its holes in a mesh program";
      }
      visitor.fault("file", "expected a closed mesh, found " + found + " (" + file_.path.string() + ")");
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
