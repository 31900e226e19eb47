// A box full of fluid, upright or turned about its centre.
#pragma once

#include "core/base/rotation.h"
#include "core/scene/fluid_source.h"

namespace migiwa {

/// The lattice has round(length / spacing) cells along each axis of the box and begins at `min`, so that a
/// box in a corner of a tank touches its walls whatever its lengths are.
class BoxSource final : public FluidSource {
 public:
  BoxSource() = default;
  BoxSource(const Vec3d& min, const Vec3d& max, const Rotation& rotation = {});

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  double count(double spacing) const override;
  void fill(double spacing, std::vector<Vec3d>& out) const override;
  Bounds bounds() const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, BoxSource>& self);
  /// Cells along each axis, as real numbers: they may be more than an integer holds.
  Vec3d cells(double spacing) const;
  Vec3d toWorld(const Vec3d& p) const;

  Vec3d min_ = Vec3d::Zero();
  Vec3d max_ = Vec3d::Ones();
  Rotation rotation_;
};

}  // namespace migiwa
