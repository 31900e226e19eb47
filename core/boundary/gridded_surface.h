// A wall whose distance is read from a grid: for shapes that take long to say how far they are, such as SLIM
// surfaces, asked by every particle near them several times a step. Everything else is the shape's own. The
// cost does not depend on what the shape is made of.
#pragma once

#include <string>

#include "core/base/parallel.h"
#include "core/boundary/spline_grid.h"
#include "core/boundary/surface.h"

namespace migiwa {

class GriddedSurface final : public Surface {
  using Grid = SplineGrid<1>;

 public:
  /// Cells along a support radius, and support radii around the wall that have a grid.
  static constexpr float kCellsPerSupport = 5, kReach = 1.6F;

  /// Throws InputError at `scenePlace` where the grid has no room in memory.
  GriddedSurface(std::shared_ptr<const Surface> shape, float supportRadius, ThreadPool& pool,
                 const std::string& scenePlace = {});

  std::shared_ptr<const Surface> exact() const override { return shape_; }

  void describe(FieldVisitor&) override {}  // the shape itself was read before
  void describe(FieldWriter& visitor) const override { shape_->describe(visitor); }
  bool steadyDistance() const override { return !grid_.coefficients.empty(); }
  /// Within kReach of the wall, that of the splines: off by about 0.001 support radii where the wall is
  /// smooth and by 0.02 next to creases, which it rounds. Farther out in the fluid no more than kReach, and
  /// deep in the solid the shape's own.
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void otherWaysOut(const Vec3f& p, float margin, std::vector<Vec3f>& out) const override {
    shape_->otherWaysOut(p, margin, out);
  }
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override {
    shape_->firstHits(origin, directions, hits);
  }
  bool reentrant() const override { return shape_->reentrant(); }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override {
    shape_->exits(origin, directions, exits);
  }
  float thickness() const override { return shape_->thickness(); }
  float thinnestPart() const override { return shape_->thinnestPart(); }
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  bool planar() const override { return shape_->planar(); }
  PieceRule pieceRule() const override { return shape_->pieceRule(); }
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override;
  Bounds bounds() const override { return shape_->bounds(); }
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override {
    shape_->wireframe(scene, out);
  }
  WallMesh mesh() const override { return shape_->mesh(); }
  void drawnNodes(std::vector<WallNode>& out) const override { shape_->drawnNodes(out); }
  const BoxGeometry* tank() const override { return shape_->tank(); }

 private:
  /// The spline's value and unit gradient, in a block that has coefficients.
  float interpolate(const Grid::Place& place, Vec3f& normal) const;
  /// Whether the wall is certainly farther than `reach` from p.
  bool outOfReach(const Vec3f& p, float reach) const;

  std::shared_ptr<const Surface> shape_;
  Grid grid_;
  std::vector<float> least_;  ///< distance (m) that every point of a block has
  float reach_;
};

/// The surfaces, those with costly distances behind grids for this support radius (m). Where a grid would
/// take more than half a GiB the shape stays as it is. Throws InputError at `place` where a smaller one
/// has no room in this machine's memory.
std::vector<std::shared_ptr<const Surface>> withDistanceGrids(
    const std::vector<std::shared_ptr<const Surface>>& surfaces, float supportRadius, ThreadPool& pool,
    const std::string& place = {});

}  // namespace migiwa
