// A box wall, upright or turned about its centre: a tank with the fluid inside, or a block with the fluid
// outside.
#pragma once

#include "core/base/rotation.h"
#include "core/boundary/surface.h"

namespace migiwa {

class Box final : public Surface {
 public:
  enum class Fluid { inside, outside };

  Box() = default;
  Box(const Vec3d& min, const Vec3d& max, Fluid fluid, const Rotation& rotation = {});

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void otherWaysOut(const Vec3f& p, float margin, std::vector<Vec3f>& out) const override;
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  bool reentrant() const override { return fluid_ == Fluid::outside; }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override;
  float thickness() const override;
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  bool planar() const override { return true; }
  PieceRule pieceRule() const override {
    return fluid_ == Fluid::inside ? PieceRule::fluidInsideAll : PieceRule::solidInsideAll;
  }
  Bounds bounds() const override;
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override;
  const BoxGeometry* tank() const override { return fluid_ == Fluid::inside ? &geometry_ : nullptr; }

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Box>& self);
  /// Where a ray enters the box and where it leaves it; no crossing unless enter < leave.
  struct Crossing {
    float enter, leave;
  };
  Crossing crossing(const Vec3f& local, const Directions& directions, std::size_t k) const;
  void prepare();
  Vec3f toLocal(const Vec3f& p) const { return toLocal_ * (p - center_); }
  Vec3f toWorld(const Vec3f& local) const { return center_ + toLocal_.transpose() * local; }
  Vec3d corner(int index) const;

  Vec3d min_ = Vec3d::Zero(), max_ = Vec3d::Ones();
  Rotation rotation_;
  Fluid fluid_ = Fluid::inside;
  BoxGeometry geometry_;
  Vec3f center_ = Vec3f::Constant(0.5F), half_ = Vec3f::Constant(0.5F);
  Eigen::Matrix3f toLocal_ = Eigen::Matrix3f::Identity();
};

}  // namespace migiwa
