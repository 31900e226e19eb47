#include "core/walls/moving.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Geometry>

#include "core/base/fields.h"
#include "core/base/math.h"
#include "core/walls/surface.h"

namespace migiwa {

namespace {

constexpr std::array<std::string_view, 2> kInterpolationNames{"smooth", "linear"};
constexpr Range kAngleRange{-36000, 36000};

/// Where the keyframes put the wall: at the first before all of them, at the last after.
Keyframe between(const std::vector<Keyframe>& keyframes, double time, Interpolation interpolation) {
  if (keyframes.empty()) return {};
  const auto next = std::find_if(keyframes.begin(), keyframes.end(),
                                 [time](const Keyframe& frame) { return frame.time > time; });
  if (next == keyframes.begin()) return keyframes.front();
  if (next == keyframes.end()) return keyframes.back();
  const Keyframe& before = *(next - 1);
  const double part = (time - before.time) / (next->time - before.time);
  const double way = interpolation == Interpolation::smooth ? part * part * (3 - 2 * part) : part;
  return {time, before.translate + way * (next->translate - before.translate),
          before.degrees + way * (next->degrees - before.degrees)};
}

/// The keys of a motion, in the order in which they are best written.
template <class Visitor>
void fieldsOf(Visitor& visitor, Visited<Visitor, Motion>& motion) {
  visitor.vector("velocity", motion.velocity, {"m/s", "Constant velocity."});
  visitor.object(
      "rotation", {"", "The axis of every turn, and a constant turn about it."},
      [&](auto& fields) {
        fields.vector("axis", motion.axis, {"1", "Any length but zero.", Presence::required});
        fields.place("point", motion.point,
                     {"m", "A point of the axis; it moves along with the wall.", Presence::required});
        fields.number("degrees_per_second", motion.degreesPerSecond, kAngleRange,
                      {"degrees/s", "Constant turn, right-handed."});
        if constexpr (Visitor::kChanges) {
          if (motion.axis.norm() >= 1e-12) return;
          fields.fault("axis", "expected a vector that is not zero, found [0, 0, 0]");
          motion.axis = Vec3d::UnitY();
        }
      },
      &motion.turns);
  visitor.object(
      "oscillation", {"", "To and fro, as the sine of time: a wave maker, a shaker."},
      [&](auto& fields) {
        fields.vector("amplitude", motion.amplitude, {"m", "Direction and amplitude of the sway."});
        fields.number("degrees", motion.swing, kAngleRange,
                      {"degrees", "Amplitude of a turn about the axis of rotation."});
        fields.number("period", motion.period, Range::closed(1e-6, 1e6),
                      {"s", "Of one oscillation.", Presence::required});
      },
      &motion.oscillates);
  visitor.number("start", motion.start, Range::closed(0, 1e6),
                 {"s", "When velocity, rotation and oscillation begin."});
  visitor.number("stop", motion.stop, Range::closed(0, 1e6),
                 {"s", "When they end; the wall stays where it is then."});
  if (visitor.valid({"start", "stop"}) && motion.stop <= motion.start)
    visitor.fault("stop", "expected a time after start, found an earlier one");
  auto& keyframes = motion.keyframes;
  visitor.list(
      "keyframes", keyframes.size(), {"", "Places at given times, relative to where the wall is described."},
      [&](auto& fields, std::size_t at) {
        if constexpr (Visitor::kChanges)
          if (at >= keyframes.size()) keyframes.emplace_back();
        auto& frame = keyframes[at];
        fields.number("time", frame.time, Range::closed(0, 1e6), {"s", "When.", Presence::required});
        fields.vector("translate", frame.translate, {"m", "How far from its place."});
        fields.number("degrees", frame.degrees, kAngleRange,
                      {"degrees", "How far turned about the axis of rotation."});
        if (at > 0 && fields.valid({"time"}) && frame.time <= keyframes[at - 1].time)
          fields.fault("time", "expected a time after that of the keyframe before, found an earlier one");
      });
  visitor.choice("interpolation", motion.interpolation, kInterpolationNames,
                 {"", "Between keyframes: at rest at each of them, or at a constant velocity."});
}

}  // namespace

void Motion::describe(FieldWriter& visitor) const {
  fieldsOf(visitor, *this);
}

void Motion::describe(FieldVisitor& visitor) {
  fieldsOf(visitor, *this);
  if (!visitor.valid({"velocity", "rotation", "oscillation", "keyframes"})) return;
  const bool turned =
      (oscillates && swing != 0) ||
      std::any_of(keyframes.begin(), keyframes.end(), [](const auto& frame) { return frame.degrees != 0; });
  if (turned && !turns)
    visitor.fault("", "expected rotation with the axis and point that degrees turn about, found none");
  const bool moves =
      velocity.norm() > 0 || (turns && degreesPerSecond != 0) || oscillates || !keyframes.empty();
  if (!moves)
    visitor.fault(
        "", "expected a velocity, degrees_per_second, oscillation or keyframes, found nothing that moves");
}

Pose Motion::at(double time) const {
  const double moving = std::clamp(time, start, stop) - start;
  const Keyframe frame = between(keyframes, time, interpolation);
  const double sine = oscillates ? portable::sin(2 * std::numbers::pi * moving / period) : 0;
  Pose pose = Pose::Identity();
  pose.translation() = moving * velocity + sine * amplitude + frame.translate;
  if (turns) {
    const double degrees = moving * degreesPerSecond + sine * swing + frame.degrees;
    pose.linear() = rotationAbout(axis.normalized(), degrees * std::numbers::pi / 180);
    pose.translation() += point - pose.linear() * point;
  }
  return pose;
}

bool Motion::sameAs(const Motion& other) const {
  const auto equal = [](const Keyframe& a, const Keyframe& b) {
    return a.time == b.time && a.translate == b.translate && a.degrees == b.degrees;
  };
  return velocity == other.velocity && turns == other.turns && axis == other.axis && point == other.point &&
         degreesPerSecond == other.degreesPerSecond && oscillates == other.oscillates &&
         amplitude == other.amplitude && swing == other.swing && period == other.period &&
         start == other.start && stop == other.stop && interpolation == other.interpolation &&
         std::equal(keyframes.begin(), keyframes.end(), other.keyframes.begin(), other.keyframes.end(),
                    equal);
}

namespace {

std::array<Vec3d, 8> corners(const Bounds& bounds) {
  std::array<Vec3d, 8> result;
  for (std::size_t k = 0; k < 8; ++k)
    for (int axis = 0; axis < 3; ++axis)
      result[k][axis] = (k >> axis & 1) != 0 ? bounds.max[axis] : bounds.min[axis];
  return result;
}

/// Directions in the wall's rest frame. Each thread has its own: shapes know directions by their place in
/// memory within one evaluation.
const Directions& turned(const Directions& directions, const Eigen::Matrix3f& turn) {
  thread_local Directions result;
  const std::size_t n = directions.size();
  result.x.resize(n), result.y.resize(n), result.z.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3f w = turn * Vec3f(directions.x[k], directions.y[k], directions.z[k]);
    result.x[k] = w.x(), result.y[k] = w.y(), result.z[k] = w.z();
  }
  return result;
}

}  // namespace

MovingSurface::MovingSurface(std::shared_ptr<const Surface> rest, int group)
    : rest_(std::move(rest)), group_(group) {
  moveTo(0, 0);
}

Vec3f MovingSurface::toRest(const Vec3f& p) const {
  return toRest_ * (p - shift_);
}

Vec3f MovingSurface::toWorld(const Vec3f& p) const {
  return toRest_.transpose() * p + shift_;
}

Vec3f MovingSurface::directionToWorld(const Vec3f& direction) const {
  return toRest_.transpose() * direction;
}

Vec3f MovingSurface::carriedDirection(const Vec3f& direction) const {
  return carryTurn_ * direction;
}

Vec3f MovingSurface::velocity(const Vec3f& p) const {
  return spin_ * p + drift_;
}

Vec3f MovingSurface::carried(const Vec3f& p) const {
  return carryTurn_ * p + carryShift_;
}

void MovingSurface::moveTo(double before, double now) {
  const Pose old = motion().at(before);
  const Pose pose = motion().at(now);
  now_ = now;
  turned_ = !(pose.linear() - Eigen::Matrix3d::Identity()).isZero(1e-12);
  toRest_ = pose.linear().transpose().cast<float>();
  shift_ = pose.translation().cast<float>();

  const Pose carry = pose * old.inverse();
  moved_ = !(carry.matrix() - Eigen::Matrix4d::Identity()).isZero(1e-12);
  carryTurn_ = carry.linear().cast<float>();
  carryShift_ = carry.translation().cast<float>();
  spin_.setZero();
  drift_.setZero();
  if (!moved_) return;
  // Where a point of the wall is now, less where it was: in double, for steps are short.
  const Pose back = carry.inverse();
  spin_ = ((Eigen::Matrix3d::Identity() - back.linear()) / (now - before)).cast<float>();
  drift_ = (-back.translation() / (now - before)).cast<float>();
}

float MovingSurface::distance(const Vec3f& p, Vec3f& normal) const {
  const float result = rest_->distance(toRest(p), normal);
  normal = directionToWorld(normal);
  return result;
}

bool MovingSurface::project(Vec3f& p, float margin) const {
  Vec3f local = toRest(p);
  if (!rest_->project(local, margin)) return false;
  p = toWorld(local);
  return true;
}

void MovingSurface::otherWaysOut(const Vec3f& p, float margin, std::vector<Vec3f>& out) const {
  const std::size_t before = out.size();
  rest_->otherWaysOut(toRest(p), margin, out);
  for (std::size_t k = before; k < out.size(); ++k) out[k] = toWorld(out[k]);
}

void MovingSurface::firstHits(const Vec3f& origin, const Directions& directions,
                              std::span<float> hits) const {
  rest_->firstHits(toRest(origin), turned_ ? turned(directions, toRest_) : directions, hits);
}

void MovingSurface::exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const {
  rest_->exits(toRest(origin), turned_ ? turned(directions, toRest_) : directions, exits);
}

bool MovingSurface::crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const {
  if (!rest_->crosses(toRest(from), toRest(to), normal, entry)) return false;
  normal = directionToWorld(normal);
  return true;
}

void MovingSurface::pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const {
  const std::size_t before = out.size();
  rest_->pieces(toRest(p), reach, out);
  for (std::size_t k = before; k < out.size(); ++k) {
    out[k].normal = directionToWorld(out[k].normal);
    out[k].foot = toWorld(out[k].foot);
  }
}

void MovingSurface::facets(const Vec3f& p, float supportRadius, std::vector<WallFacet>& out) const {
  const std::size_t before = out.size();
  rest_->facets(toRest(p), supportRadius, out);
  for (std::size_t k = before; k < out.size(); ++k) {
    out[k].normal = directionToWorld(out[k].normal);
    for (Vec3f& corner : out[k].corners) corner = toWorld(corner);
  }
}

std::optional<ClosedForm> MovingSurface::closedForm() const {
  std::optional<ClosedForm> form = rest_->closedForm();
  if (!form) return form;
  const Pose pose = motion().at(now_);
  form->center = pose * form->center;
  form->axes = pose.linear() * form->axes;
  return form;
}

Bounds MovingSurface::bounds() const {
  return migiwa::moved(rest_->bounds(), motion().at(now_));
}

void MovingSurface::wireframe(const Bounds& scene, std::vector<LineSegment>& out) const {
  const std::size_t before = out.size();
  rest_->wireframe(migiwa::moved(scene, motion().at(now_).inverse()), out);
  for (std::size_t k = before; k < out.size(); ++k) out[k] = {toWorld(out[k].from), toWorld(out[k].to)};
}

WallMesh MovingSurface::mesh() const {
  WallMesh mesh = rest_->mesh();
  for (Vec3f& vertex : mesh.surface.vertices) vertex = toWorld(vertex);
  for (Vec3f& normal : mesh.normals) normal = directionToWorld(normal);
  return mesh;
}

void MovingSurface::drawnNodes(std::vector<WallNode>& out) const {
  const std::size_t before = out.size();
  rest_->drawnNodes(out);
  for (std::size_t k = before; k < out.size(); ++k) {
    out[k].centre = toWorld(out[k].centre);
    out[k].normal = directionToWorld(out[k].normal);
  }
}

Bounds moved(const Bounds& bounds, const Pose& pose) {
  Bounds result;
  if (bounds.empty()) return result;
  for (const Vec3d& corner : corners(bounds)) result.include(pose * corner);
  return result;
}

Bounds sweptBounds(const Surface& surface, double duration) {
  if (!surface.motion) return surface.bounds();
  constexpr int kPlaces = 256;
  Bounds result;
  for (int k = 0; k <= kPlaces; ++k)
    result.include(moved(surface.bounds(), surface.motion->at(duration * k / kPlaces)));
  return result;
}

double largestSpeed(const Motion& motion, const Bounds& bounds, double from, double to) {
  constexpr int kParts = 8;
  const double part = (to - from) / kParts;
  if (bounds.empty() || part <= 0) return 0;
  double farthest = 0;
  Pose before = motion.at(from);
  for (int k = 1; k <= kParts; ++k) {
    const Pose after = motion.at(from + k * part);
    for (const Vec3d& corner : corners(bounds))
      farthest = std::max(farthest, (after * corner - before * corner).norm());
    before = after;
  }
  return farthest / part;
}

}  // namespace migiwa
