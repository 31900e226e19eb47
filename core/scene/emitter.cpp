#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/math.h"
#include "core/scene/sources.h"

namespace migiwa {

namespace {

/// Layers follow each other in the time that one takes to pass, which has to be one.
constexpr Range kMouthSpeeds = Range::closed(1e-9, 1e4);

/// The directions along and across a mouth.
struct MouthFrame {
  Vec3d x, y;
};
MouthFrame frameOf(const Emitter& emitter) {
  const Vec3d ahead = emitter.direction.normalized();
  const Vec3d along = emitter.xAxis - emitter.xAxis.dot(ahead) * ahead;
  const Vec3d x = along.norm() > 0 ? Vec3d(along.normalized()) : ahead.unitOrthogonal();
  return {x, ahead.cross(x)};
}

/// Places of a square lattice of unit cells within a disc, with a place or a corner of four cells at its
/// centre: whichever of the two comes nearer to the disc's area.
std::vector<std::array<double, 2>> discLattice(double radius) {
  std::vector<std::array<double, 2>> best;
  double least = std::numeric_limits<double>::infinity();
  const int reach = static_cast<int>(std::ceil(radius)) + 1;
  for (const double shift : {0.5, 0.0}) {
    std::vector<std::array<double, 2>> places;
    for (int i = -reach; i <= reach; ++i)
      for (int j = -reach; j <= reach; ++j)
        if (portable::hypot(i + shift, j + shift) <= radius) places.push_back({i + shift, j + shift});
    const double error = std::abs(static_cast<double>(places.size()) - std::numbers::pi * radius * radius);
    if (places.empty() || error >= least) continue;
    least = error;
    best = std::move(places);
  }
  return best;
}

constexpr FieldDoc kMouthDoc{"", "Of its mouth.", Presence::required};

}  // namespace

template <class Visitor>
void Emitter::fields(Visitor& visitor, Visited<Visitor, Emitter>& self) {
  visitor.place("center", self.center, {"m", "Of the mouth.", Presence::required});
  if (self.shape == MouthShape::disc) {
    visitor.number("radius", self.radius, Range::length(kLargestCoordinate),
                   {"m", "Of the mouth.", Presence::required});
  } else {
    visitor.pair("size", self.size, {"m", "Of the mouth, along x_axis and across.", Presence::required});
    visitor.vector("x_axis", self.xAxis, {"1", "Direction of its first side; left out: any."});
  }
  visitor.vector("direction", self.direction,
                 {"1", "In which the fluid leaves; any length but zero.", Presence::required});
  visitor.number("speed", self.speed, Range::closed(0, 1e4),
                 {"m/s", "Of the fluid at the mouth: volume a second over the area of the mouth."});
  visitor.number("rate", self.rate, Range::closed(0, 1e9),
                 {"m^3/s", "Instead of speed: volume that leaves in a second."});
  visitor.number("start", self.start, Range::closed(0, 1e6), {"s", "When it begins."});
  visitor.number("stop", self.stop, Range::closed(0, 1e6), {"s", "When it ends."});
  visitor.integer("particles", self.particles, Range::closed(1, 2e9),
                  {"1", "That it gives at most; then it runs dry."});
}

void Emitter::describe(FieldWriter& visitor) const {
  describeShaped(visitor, shape, kMouthShapeNames, kMouthDoc,
                 [this](FieldWriter& mouth) { fields(mouth, *this); });
}

void Emitter::describe(FieldVisitor& visitor, double spacing) {
  describeShaped(visitor, shape, kMouthShapeNames, kMouthDoc, [&](FieldVisitor& mouth) {
    fields(mouth, *this);
    check(mouth, spacing);
  });
}

void Emitter::check(FieldVisitor& visitor, double spacing) {
  if (visitor.valid({"direction"}) && direction.norm() < 1e-12) {
    visitor.fault("direction", "expected a vector that is not zero, found [0, 0, 0]");
    direction = -Vec3d::UnitY();
  }
  if (shape == MouthShape::rectangle && visitor.valid({"size"}) && (size[0] <= 0 || size[1] <= 0)) {
    visitor.fault("size", "expected two lengths greater than 0, found one that is not");
    size = {1, 1};
  }
  if (visitor.valid({"x_axis", "direction"}) && xAxis.norm() > 0 &&
      xAxis.cross(direction).norm() < 1e-6 * xAxis.norm() * direction.norm())
    visitor.fault("x_axis", "expected a direction across that of the fluid, found one along it");
  if (visitor.valid({"speed", "rate"}) && (speed > 0) == (rate > 0)) {
    visitor.fault("", std::string("expected either speed or rate, greater than 0, found ") +
                          (speed > 0 ? "both" : "neither"));
    speed = 1;
  } else if (visitor.valid({"speed", "rate", "radius", "size"}) && !kMouthSpeeds.contains(mouthSpeed())) {
    std::ostringstream text;
    text << "expected a speed at the mouth " << kMouthSpeeds.text() << " (unit: m/s), found " << mouthSpeed();
    if (rate > 0) text << ", rate over the mouth's area of " << area() << " m^2; another of the two helps";
    visitor.fault(rate > 0 ? "rate" : "speed", text.str());
  }
  if (visitor.valid({"start", "stop"}) && stop <= start)
    visitor.fault("stop", "expected a time after start, found an earlier one");
  if (spacing <= 0 || !visitor.valid({"radius", "size"})) return;
  // One too large to be counted by making it has about as many as its area says.
  constexpr double kCounted = 1e5;
  const double about = area() / (spacing * spacing);
  const double layer =
      about < kCounted ? static_cast<double>(mouthLayer(*this, spacing).places.size()) : std::ceil(about);
  if (layer == 0)
    visitor.fault("", "expected a mouth with room for a particle, found one smaller than particle_spacing");
  if (layer > particles && visitor.valid({"particles"})) {
    std::ostringstream text;
    text << "expected at least the " << layer << " particles of one layer in the mouth, found " << particles
         << "; a larger particle_spacing makes fewer";
    visitor.fault("particles", text.str());
  }
}

double Emitter::area() const {
  return shape == MouthShape::disc ? std::numbers::pi * radius * radius : size[0] * size[1];
}

double Emitter::count(double spacing, double time) const {
  const double flowing = std::min(time, stop) - start;
  if (flowing < 0) return 0;
  const double volume = area() * (mouthSpeed() * flowing + 2 * spacing);
  return std::min(volume / (spacing * spacing * spacing), static_cast<double>(particles));
}

Bounds Emitter::bounds() const {
  // A mouth that is much longer than wide has as many places along it as this.
  constexpr double kMostAlong = 1e6;
  const double spacing = 0.25 * std::sqrt(area());
  Bounds bounds;
  if (shape == MouthShape::disc) {
    for (const Vec3d& place : mouthLayer(*this, spacing).places) bounds.include(place);
    return bounds;
  }
  const MouthFrame frame = frameOf(*this);
  std::array<double, 2> first{};
  for (std::size_t k = 0; k < 2; ++k)
    first[k] = 0.5 / std::clamp(std::round(size[k] / spacing), 1.0, kMostAlong) - 0.5;
  for (const double u : {first[0], -first[0]})
    for (const double v : {first[1], -first[1]})
      bounds.include(center + u * size[0] * frame.x + v * size[1] * frame.y);
  return bounds;
}

std::vector<Vec3d> Emitter::outline() const {
  constexpr int kAround = 48;
  const auto [x, y] = frameOf(*this);
  std::vector<Vec3d> corners;
  if (shape == MouthShape::disc) {
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      corners.emplace_back(center + radius * (portable::cos(angle) * x + portable::sin(angle) * y));
    }
    return corners;
  }
  for (const auto& [u, v] : {std::pair(-0.5, -0.5), {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
    corners.emplace_back(center + u * size[0] * x + v * size[1] * y);
  return corners;
}

MouthLayer mouthLayer(const Emitter& emitter, double spacing) {
  const auto [x, y] = frameOf(emitter);
  MouthLayer layer;
  if (emitter.shape == MouthShape::disc) {
    // The lattice is drawn out or in by as much as its places differ from the area.
    const auto places = discLattice(emitter.radius / spacing);
    const double cell = std::sqrt(emitter.area() / std::max<double>(static_cast<double>(places.size()), 1));
    for (const auto& [i, j] : places) layer.places.emplace_back(emitter.center + cell * (i * x + j * y));
  } else {
    const auto cells = [&](double length) { return std::lround(length / spacing); };
    const long columns = cells(emitter.size[0]), rows = columns > 0 ? cells(emitter.size[1]) : 0;
    for (long j = 0; j < rows; ++j) {
      for (long i = 0; i < columns; ++i) {
        const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(columns) - 0.5;
        const double v = (static_cast<double>(j) + 0.5) / static_cast<double>(rows) - 0.5;
        layer.places.emplace_back(emitter.center + u * emitter.size[0] * x + v * emitter.size[1] * y);
      }
    }
  }
  layer.thickness = static_cast<double>(layer.places.size()) * (spacing * spacing * spacing) / emitter.area();
  return layer;
}

}  // namespace migiwa
