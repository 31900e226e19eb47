// Where fluid is taken away while the simulation runs.
#pragma once

#include <array>
#include <string_view>

#include "core/base/fields.h"
#include "core/base/math.h"

namespace migiwa {

// A region that takes every particle whose centre is in it: an outlet, an overflow, a pump.

enum class DrainShape { box, sphere };
inline constexpr std::array<std::string_view, 2> kDrainShapeNames{"box", "sphere"};

struct Drain {
  DrainShape shape = DrainShape::box;
  Vec3d min = Vec3d::Zero();     ///< corner of a box, before the rotation (unit: m)
  Vec3d max = Vec3d::Ones();     ///< the opposite corner (unit: m)
  Rotation rotation;             ///< of a box, about its centre
  Vec3d center = Vec3d::Zero();  ///< of a sphere (unit: m)
  double radius = 1;             ///< of a sphere (unit: m)
  double start = 0;              ///< (unit: s)
  double stop = 1e6;             ///< (unit: s)

  /// Visits the fields of the scene file's object. `spacing` (m) is the particles'; zero: not known.
  void describe(FieldVisitor& visitor, double spacing);
  void describe(FieldWriter& visitor) const;

  bool openAt(double time) const { return start <= time && time < stop; }

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Drain>& self);
  void check(FieldVisitor& visitor, double spacing);
};

/// A drain ready to be asked of every particle.
class DrainRegion {
 public:
  explicit DrainRegion(const Drain& drain);

  /// Whether a point (m) is in it; its surface counts.
  bool contains(const Vec3d& p) const { return within(p, 0); }
  /// The same of one grown by `distance` (m) on all sides; the corners of a box stay sharp.
  bool within(const Vec3d& p, double distance) const;
  Bounds bounds() const;

 private:
  bool sphere_;
  Vec3d center_, half_;   ///< (m); of a sphere, half_ is the radius
  Eigen::Matrix3d axes_;  ///< of a box, columns
};

}  // namespace migiwa
