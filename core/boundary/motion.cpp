#include "core/boundary/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/portable_math.h"
#include "core/base/rotation.h"

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
        fields.vector("point", motion.point,
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
  if (visitor.sound({"start", "stop"}) && motion.stop <= motion.start)
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
        if (at > 0 && fields.sound({"time"}) && frame.time <= keyframes[at - 1].time)
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
  if (!visitor.sound({"velocity", "rotation", "oscillation", "keyframes"})) return;
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

}  // namespace migiwa
