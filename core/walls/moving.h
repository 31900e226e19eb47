// A wall that moves: any shape, asked in its own rest frame. Between two calls of moveTo() it stands still,
// so every gamma method works on it as on any other wall.
#pragma once

#include "core/walls/surface.h"

namespace migiwa {

class MovingSurface final : public Surface {
 public:
  /// The wall where `rest->motion` has it at time 0. Walls of the same group never move relative to each
  /// other.
  MovingSurface(std::shared_ptr<const Surface> rest, int group);

  /// Puts the wall where it is at `now` (s), having been at its place of `before` a step ago.
  void moveTo(double before, double now);

  const std::shared_ptr<const Surface>& rest() const { return rest_; }
  const Motion& motion() const { return *rest_->motion; }
  int group() const { return group_; }
  /// Whether the last step has moved it.
  bool moved() const { return moved_; }
  Vec3f toRest(const Vec3f& p) const;
  Vec3f toWorld(const Vec3f& p) const;
  Vec3f directionToWorld(const Vec3f& direction) const;
  /// A direction fixed to the wall a step ago, now.
  Vec3f carriedDirection(const Vec3f& direction) const;

  void describe(FieldVisitor&) override {}  // what stands at rest was read before
  void describe(FieldWriter& visitor) const override { rest_->describe(visitor); }
  Vec3f velocity(const Vec3f& p) const override;
  Vec3f carried(const Vec3f& p) const override;
  /// It goes elsewhere by itself.
  bool steadyDistance() const override { return false; }
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void otherWaysOut(const Vec3f& p, float margin, std::vector<Vec3f>& out) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  float statedError(const Vec3f& p) const override { return rest_->statedError(toRest(p)); }
  bool reentrant() const override { return rest_->reentrant(); }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override;
  float thickness() const override { return rest_->thickness(); }
  float thinnestPart() const override { return rest_->thinnestPart(); }
  bool passable(float supportRadius) const override { return rest_->passable(supportRadius); }
  bool thinWithin(const Vec3f& p, float reach, float supportRadius) const override {
    return rest_->thinWithin(toRest(p), reach, supportRadius);
  }
  bool convex() const override { return rest_->convex(); }
  bool hides(const Vec3f& from, const Vec3f& to) const override {
    return rest_->hides(toRest(from), toRest(to));
  }
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  bool planar() const override { return rest_->planar(); }
  PieceRule pieceRule() const override { return rest_->pieceRule(); }
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override;
  bool faceted() const override { return rest_->faceted(); }
  void facets(const Vec3f& p, float supportRadius, std::vector<WallFacet>& out) const override;
  std::optional<ClosedForm> closedForm() const override;
  Bounds bounds() const override;
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override;
  WallMesh mesh() const override;
  void drawnNodes(std::vector<WallNode>& out) const override;

 private:
  std::shared_ptr<const Surface> rest_;
  int group_;
  double now_ = 0;  ///< where it is (s)
  bool moved_ = false;
  bool turned_ = false;  ///< against the rest frame
  Eigen::Matrix3f toRest_ = Eigen::Matrix3f::Identity();
  Vec3f shift_ = Vec3f::Zero();
  // Of the last step.
  Eigen::Matrix3f carryTurn_ = Eigen::Matrix3f::Identity(), spin_ = Eigen::Matrix3f::Zero();
  Vec3f carryShift_ = Vec3f::Zero(), drift_ = Vec3f::Zero();
};

/// Bounds after a rigid move; empty ones stay empty.
Bounds moved(const Bounds& bounds, const Pose& pose);
/// What a wall covers from the start to `duration` (s).
Bounds sweptBounds(const Surface& surface, double duration);
/// The largest speed (m/s) of a point of `bounds` on a wall with this motion, between `from` and `to` (s).
double largestSpeed(const Motion& motion, const Bounds& bounds, double from, double to);

}  // namespace migiwa
