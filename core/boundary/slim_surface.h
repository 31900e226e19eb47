// A wall that is a SLIM surface ([FM] section 5): balls with a polynomial each. Read from a file of migiwa
// slim, or fitted to a mesh, a point cloud or the formula of a bowl when the scene is read.
#pragma once

#include <array>
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
  void describe(FieldWriter& visitor) const override;
  bool costlyDistance() const override { return data_ && data_->model->closed(); }
  /// Not without a grid: nodes end, and are looked at closely only near the surface.
  bool steadyDistance() const override { return false; }
  float distance(const Vec3f& p, Vec3f& normal) const override;
  std::optional<double> fitError() const override { return slimFitError(source_, *data_->model); }
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
  template <class Visitor>
  static void describeFluid(Visitor& visitor, Visited<Visitor, SlimSurface>& self) {
    visitor.choice("fluid", self.fluid_, kFluidNames,
                   {"", "The side of the wall that holds the fluid.", Presence::required});
  }
  template <class Visitor>
  static void describeTransform(Visitor& visitor, Visited<Visitor, SlimSurface>& self) {
    visitor.object("transform", {"", "Where the shape of the file stands in the scene."},
                   [&](auto& transform) { Transform::describe(transform, self.source_.transform); });
  }
  /// Takes `file` for what the surface is made of.
  void setFile(SlimSource::Kind kind, const FileName& file);
  /// Prepares `source_`; faults are reported at `key`.
  void prepare(FieldVisitor& visitor, std::string_view key);

 private:
  static constexpr std::array<std::string_view, 2> kFluidNames{"inside", "outside"};

  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, SlimSurface>& self, Visited<Visitor, bool>& bowl);
  template <class Visitor>
  static void describeBowl(Visitor& visitor, Visited<Visitor, Bowl>& bowl);
  template <class Visitor>
  static void describeFit(Visitor& visitor, Visited<Visitor, SlimSource>& source);
  bool holdsFluid() const { return fluid_ == Fluid::inside; }

  SlimSource source_;
  std::shared_ptr<const SlimWallData> data_;  ///< of source_; null until described without a fault
  Fluid fluid_ = Fluid::outside;
  FileName slimFile_, meshFile_;
};

}  // namespace migiwa
