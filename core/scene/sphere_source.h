// A ball of fluid.
#pragma once

#include "core/scene/fluid_source.h"

namespace migiwa {

/// The lattice has round(diameter / spacing) cells along each axis, centred on the ball; the cells whose
/// centres lie in the ball are filled.
class SphereSource final : public FluidSource {
 public:
  SphereSource() = default;
  SphereSource(const Vec3d& center, double radius) : center_(center), radius_(radius) {}

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  double count(double spacing) const override;
  void fill(double spacing, std::vector<Vec3d>& out) const override;
  Bounds bounds() const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, SphereSource>& self);
  Vec3d center_ = Vec3d::Zero();
  double radius_ = 1;
};

}  // namespace migiwa
