// A mouth that gives fluid while the simulation runs: a faucet, a nozzle, a spring. It gives whole layers of
// particles, one behind the other, so that the density is right from the mouth on and the volume follows the
// rate to within a layer.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/fields.h"

namespace migiwa {

enum class MouthShape { disc, rectangle };
inline constexpr std::array<std::string_view, 2> kMouthShapeNames{"disc", "rectangle"};

struct Emitter {
  MouthShape shape = MouthShape::disc;
  Vec3d center = Vec3d::Zero();          ///< of the mouth (unit: m)
  double radius = 0.1;                   ///< of a disc (unit: m)
  std::array<double, 2> size{0.2, 0.2};  ///< of a rectangle, along its x axis and across (unit: m)
  Vec3d xAxis = Vec3d::Zero();           ///< of a rectangle; zero: any
  Vec3d direction = -Vec3d::UnitY();     ///< in which the fluid leaves; any length but zero
  double speed = 0;                      ///< of the fluid at the mouth (unit: m/s); zero: by the rate
  double rate = 0;                       ///< volume in a second (unit: m^3/s); zero: by the speed
  double start = 0;                      ///< (unit: s)
  double stop = 1e6;                     ///< (unit: s)
  int particles = 100000;                ///< that it gives at most

  /// Visits the fields of the scene file's object. `spacing` (m) is the particles'; zero: not known.
  void describe(FieldVisitor& visitor, double spacing);
  void describe(FieldWriter& visitor) const;

  double area() const;  ///< (m^2)
  /// Speed of the fluid at the mouth (m/s), whichever of speed and rate is given.
  double mouthSpeed() const { return rate > 0 ? rate / area() : speed; }
  /// Particles that it gives up to `time` (s), at most: a layer more than the rate asks for.
  double count(double spacing, double time) const;
  Bounds bounds() const;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Emitter>& self);
  void check(FieldVisitor& visitor, double spacing);
};

/// A layer of particles in the mouth.
struct MouthLayer {
  std::vector<Vec3d> places;  ///< (m)
  double thickness = 0;       ///< distance to the next layer (m): area * thickness holds the layer's volume
};
MouthLayer mouthLayer(const Emitter& emitter, double spacing);

}  // namespace migiwa
