// An infinite plane wall.
#pragma once

#include "core/boundary/surface.h"

namespace migiwa {

class Plane final : public Surface {
 public:
  Plane() = default;
  /// `normal` need not be a unit vector; it points into the fluid.
  Plane(const Vec3d& point, const Vec3d& normal);

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  bool planar() const override { return true; }
  Bounds bounds() const override { return {}; }
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Plane>& self);
  void prepare();

  Vec3d point_ = Vec3d::Zero();
  Vec3d normal_ = Vec3d::UnitY();
  Vec3f unit_ = Vec3f::UnitY();
  float offset_ = 0;  ///< unit . x on the plane
};

}  // namespace migiwa
