// The walls of a picture as bodies of glass or matt material.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "app/raytrace/embree.h"
#include "core/walls/surface.h"

namespace migiwa {

/// Where a ray meets the surface of a body.
struct BodyHit {
  float distance = std::numeric_limits<float>::infinity();  ///< (m)
  Vec3f normal = Vec3f::UnitY();                            ///< unit, out of the body
  Vec3f shading = Vec3f::UnitY();  ///< unit, the same but smooth across the triangles of what is round
  bool outside = false;            ///< of a shell, on the side that never meets the fluid
};

/// A half-space, a box or a ball.
class ConvexSolid {
 public:
  explicit ConvexSolid(const ClosedForm& form);

  /// Where a ray is inside: between two distances (m), with the outward normals there. `from` is greater than
  /// `to` where it never is.
  struct Stretch {
    float from, to;
    Vec3f entry, exit;
  };
  Stretch stretch(const Vec3f& origin, const Vec3f& direction) const;
  bool contains(const Vec3f& p) const;

 private:
  Stretch boxStretch(const Vec3f& origin, const Vec3f& direction) const;
  Stretch ballStretch(const Vec3f& origin, const Vec3f& direction) const;

  ClosedForm::Kind kind_;
  Vec3f center_, half_;
  Eigen::Matrix3f toLocal_, toWorld_;
};

/// A solid: what lies inside of a shape, a shell around it, or a half-space.
class Body {
 public:
  /// The solid of a wall, which is that of a closed form, or of its drawn mesh. Where the wall holds the
  /// fluid, glass is a shell of this thickness (m) around it; a box is open on its side towards `up` (unit).
  /// Matt material around the fluid has its inner surface alone. Nothing where the wall has neither a closed
  /// form nor a mesh.
  static std::optional<Body> around(const Surface& surface, bool glass, float thickness, const Vec3f& up);
  /// The half-space below a plane.
  static Body ground(const Vec3f& point, const Vec3f& up);

  bool glass() const { return glass_; }
  /// Whether its surface is one of triangles.
  bool meshed() const { return !rays_.empty(); }

  /// The first place, nearer than `hit.distance`, where a ray from outside enters.
  bool enter(const Vec3f& origin, const Vec3f& direction, BodyHit& hit) const;
  bool blocks(const Vec3f& origin, const Vec3f& direction, float distance) const;
  /// Where a ray from inside leaves; at once where rounding has put the origin outside. False: never.
  bool leave(const Vec3f& origin, const Vec3f& direction, BodyHit& hit) const;
  bool contains(const Vec3f& p) const;

 private:
  struct Part {
    ConvexSolid::Stretch inside;
    bool entersOutside, leavesOutside;  ///< BodyHit::outside of its ends
  };
  struct Stretches {
    std::array<Part, 2> part;
    int count = 0;
  };
  Stretches stretches(const Vec3f& origin, const Vec3f& direction) const;
  void setMesh(const WallMesh& mesh, float thickness);
  bool facing(const Vec3f& origin, const Vec3f& direction, float side, BodyHit& hit) const;

  bool glass_ = false;
  std::optional<ConvexSolid> outer_;   ///< none: triangles
  std::optional<ConvexSolid> cavity_;  ///< cut out of it
  bool hollow_ = false;                ///< the solid is all that is outside of the cavity
  TriangleRays rays_;
  std::vector<Vec3f> normals_;  ///< of the vertices, out of the body
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::size_t facingFluid_ = 0;  ///< of the triangles; the rest are the outside of a shell
  bool vessel_ = false;
  float thickness_ = 0;
  const Surface* surface_ = nullptr;  ///< of the triangles
};

}  // namespace migiwa
