// A sphere wall: a round vessel with the fluid inside, or a ball with the fluid outside.
#pragma once

#include "core/boundary/surface.h"

namespace migiwa {

class Sphere final : public Surface {
 public:
  enum class Fluid { inside, outside };

  Sphere() = default;
  Sphere(const Vec3d& center, double radius, Fluid fluid);

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  bool reentrant() const override { return fluid_ == Fluid::outside; }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override;
  float thickness() const override;
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  Bounds bounds() const override;
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Sphere>& self);
  void prepare();

  Vec3d centerExact_ = Vec3d::Zero();
  double radiusExact_ = 1;
  Fluid fluid_ = Fluid::inside;
  Vec3f center_ = Vec3f::Zero();
  float radius_ = 1;
};

}  // namespace migiwa
