// Walls made of triangles: as they are, from a mesh file.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "core/walls/slim_wall.h"
#include "core/walls/surface.h"
#include "core/walls/triangles.h"

namespace migiwa {

// A wall that is exactly its triangles: planes where they are planes, sharp where they are sharp, ending
// where they end. Closed parts enclose the solid, or the fluid; open ones are sheets without thickness that
// the fluid may wet on both sides.

class TriangleWall final : public Surface {
 public:
  /// There must be a triangle. `supportRadius` (m) says which parts of the solid are thin: those that less
  /// than it of solid lies behind. `vessel`: holds the fluid, for pictures.
  TriangleWall(std::shared_ptr<const TriangleTree> tree, bool vessel, float supportRadius = 0);

  const std::shared_ptr<const TriangleTree>& tree() const { return tree_; }
  bool vessel() const { return vessel_; }

  void describe(FieldVisitor&) override {}  // it was read as a MeshSurface
  /// Not as a scene would: what tells it from others, for what is kept about it.
  void describe(FieldWriter& visitor) const override;
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool project(Vec3f& p, float margin) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  bool reentrant() const override { return true; }
  /// Infinite behind what is thin.
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override;
  bool passable(float /*supportRadius*/) const override { return hasThick_; }
  float thickness() const override { return thickness_; }
  bool thinWithin(const Vec3f& p, float reach, float supportRadius) const override;
  bool hides(const Vec3f& from, const Vec3f& to) const override;
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  Bounds bounds() const override { return tree_->bounds(); }
  /// Nothing: the mesh shows it.
  void wireframe(const Bounds&, std::vector<LineSegment>&) const override {}
  WallMesh mesh() const override;
  bool enclosed(TriangleMesh& mesh) const override;
  bool faceted() const override { return true; }
  void facets(const Vec3f& p, float supportRadius, std::vector<WallFacet>& out) const override;

 private:
  void measureThickness();
  /// Whether it hides no other from a point on the side that its normal points to or, if `behind`, on the
  /// other.
  bool standsAlone(std::uint32_t triangle, bool behind) const;
  float thicknessBehind(const WallTriangle& triangle) const;

  std::shared_ptr<const TriangleTree> tree_;
  bool vessel_;
  float supportRadius_;
  std::vector<bool> thin_;                 ///< of each of the tree's triangles
  std::vector<bool> alone_, aloneBehind_;  ///< of each: hides no other from a point on that side
  bool hasThick_ = false;                  ///< whether there is one that is not
  float thickness_ = std::numeric_limits<float>::infinity();
};

// A wall from a mesh file. A Box stands for a mesh that is one, else a TriangleWall for its triangles, and a
// SlimSurface for points.

class MeshSurface final : public StandIn {
 public:
  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;

  /// What stands for the file, with this surface's motion.
  std::shared_ptr<const Surface> forSupport(float supportRadius) const override;

 private:
  enum class Fluid { inside, outside };
  static constexpr std::array<std::string_view, 2> kFluidNames{"inside", "outside"};

  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, MeshSurface>& self);
  void prepare(FieldVisitor& visitor);

  FileName file_;
  Fluid fluid_ = Fluid::outside;
  Transform transform_;
};

// Vessels as one: the fluid is where it is inside of any of them, so that they may open into each other.

class GroupSurface final : public StandIn {
 public:
  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  std::shared_ptr<const Surface> forSupport(float supportRadius) const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, GroupSurface>& self);
  void unite(FieldVisitor& visitor);

  std::vector<std::shared_ptr<const Surface>> vessels_;
};

/// A wall that stands for a surface with this motion, for particles of this support radius (m).
std::shared_ptr<const Surface> standFor(const Surface& wall, const std::optional<Motion>& motion,
                                        float supportRadius);

/// The box that a mesh of this bounding faces is, to a millionth of its size; null for other shapes.
std::optional<BoxGeometry> boxOf(const std::vector<WallTriangle>& faces);

}  // namespace migiwa
