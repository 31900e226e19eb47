// A wall that is a SLIM surface ([FM] section 5): balls with a polynomial each. Read from a file of migiwa
// slim, or fitted to a mesh, a point cloud or the formula of a bowl when the scene is read.
#pragma once

#include <memory>

#include "core/boundary/slim_source.h"
#include "core/boundary/surface.h"

namespace migiwa {

class SlimSurface : public Surface {
 public:
  enum class Fluid { inside, outside };

  SlimSurface() = default;
  SlimSurface(std::shared_ptr<const SlimWallData> data, Fluid fluid)
      : data_(std::move(data)), fluid_(fluid) {}

  void describe(FieldVisitor& visitor) override;
  bool costlyDistance() const override { return data_ && data_->model->closed(); }
  /// Not without a grid: nodes end, and are looked at closely only near the surface.
  bool steadyDistance() const override { return false; }
  float distance(const Vec3f& p, Vec3f& normal) const override;
  std::optional<double> fitError() const override { return slimFitError(prepared_, *data_->model); }
  bool project(Vec3f& p, float margin) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  /// Thin parts let rays out again, and a vessel may bend.
  bool reentrant() const override { return true; }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override;
  float thinnestPart() const override;
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  /// One for each node whose centre is nearer than `reach`, with that as its foot point: [FM] Eq. 14.
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override;
  Bounds bounds() const override;
  /// Nothing: the mesh shows it.
  void wireframe(const Bounds&, std::vector<LineSegment>&) const override {}
  WallMesh mesh() const override;
  void drawnNodes(std::vector<WallNode>& out) const override;

 protected:
  void describeFluid(FieldVisitor& visitor);
  void describeFit(FieldVisitor& visitor);
  void describeTransform(FieldVisitor& visitor);
  /// Prepares `source_`, unless that is what is there; faults are reported at `key`.
  void prepare(FieldVisitor& visitor, std::string_view key);

  SlimSource source_;

 private:
  bool holdsFluid() const { return fluid_ == Fluid::inside; }

  std::shared_ptr<const SlimWallData> data_;  ///< null until described without a fault
  SlimSource prepared_;                       ///< what data_ was made of
  Fluid fluid_ = Fluid::outside;
  FileName slimFile_, meshFile_;
};

}  // namespace migiwa
