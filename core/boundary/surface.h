// One solid wall: where it is, and nothing of gamma. A shape is one file that implements this interface and
// one line in surface_registry.cpp. Distances are metres, positive in the fluid; normals are unit vectors
// into the fluid.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/fields.h"
#include "core/base/types.h"
#include "core/boundary/directions.h"
#include "core/boundary/motion.h"
#include "core/boundary/wall_drawing.h"

namespace migiwa {

/// A planar piece of a wall as seen from one point.
struct WallPiece {
  Vec3f normal;         ///< unit, into the fluid
  float planeDistance;  ///< signed distance of the point to the piece's plane (m)
  Vec3f foot;           ///< closest point of the piece itself
};

/// How the pieces of one surface make up its solid.
enum class PieceRule {
  fluidInsideAll,  ///< the fluid is the intersection of the pieces' fluid sides: a tank
  solidInsideAll,  ///< the solid is the intersection of the pieces' solid sides: a block
};

/// A box tank as the settled measures need it: axes, extents, and whether the fluid is inside.
struct BoxGeometry {
  Vec3d center;
  Eigen::Matrix3d axes;  ///< columns: unit axes
  Vec3d halfExtents;     ///< metres
};

class Surface {
 public:
  virtual ~Surface() = default;

  /// Visits the fields of the scene file's object, then checks and prepares what follows from them.
  virtual void describe(FieldVisitor& visitor) = 0;
  /// Visits the same fields, and changes nothing.
  virtual void describe(FieldWriter& visitor) const = 0;

  /// How the wall moves; none: it stands still. What moves is a MovingSurface about this one, which a
  /// Boundary makes for itself, so that surfaces can be shared.
  std::optional<Motion> motion;

  /// Velocity (m/s) over the last step of the wall's material at p.
  virtual Vec3f velocity(const Vec3f& /*p*/) const { return Vec3f::Zero(); }
  /// Where a point is now that has kept its place relative to the wall over the last step.
  virtual Vec3f carried(const Vec3f& p) const { return p; }

  /// Signed distance of p, and the unit normal at the nearest point of the wall.
  virtual float distance(const Vec3f& p, Vec3f& normal) const = 0;

  /// Whether the fluid's distances are those of a closed solid, without jumps, so that how far a point can
  /// have come bounds how much nearer it is.
  virtual bool steadyDistance() const { return true; }
  /// Whether distance() takes so long that a grid in its place pays: true only for a solid that is closed.
  virtual bool costlyDistance() const { return false; }
  /// The shape itself where this one stands for it with approximate distances; null where it is exact.
  virtual std::shared_ptr<const Surface> exact() const { return nullptr; }

  /// Mean distance (m) of the wall from the shape that it was fitted to; null where it is what it says, or
  /// that shape is not at hand. Reads the shape anew.
  virtual std::optional<double> fitError() const { return std::nullopt; }

  /// Moves p to where its distance is at least `margin`, by the shortest way the shape knows; midway where
  /// two of its walls leave no room. Returns whether p moved.
  virtual bool project(Vec3f& p, float margin) const = 0;

  /// Appends other points at `margin` that p could be moved to, for where other walls bar the shortest way.
  virtual void otherWaysOut(const Vec3f&, float /*margin*/, std::vector<Vec3f>&) const {}

  /// hits[k] becomes the distance (m) from `origin` along direction k to the first point of the solid, where
  /// that is less than hits[k]. The origin is on the fluid side.
  virtual void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const = 0;
  /// Whether a ray that has hit the solid may come out of it again into fluid.
  virtual bool reentrant() const { return false; }
  /// Where it may: exits[k] becomes where direction k leaves the solid that it has hit, infinite where it
  /// does not.
  virtual void exits(const Vec3f&, const Directions&, std::span<float> exits) const {
    std::fill(exits.begin(), exits.end(), std::numeric_limits<float>::infinity());
  }

  /// The least way through the solid (m), infinite where there is no far side. What lies behind a solid
  /// thinner than the support radius does not count: gamma takes only the fluid that the point sees, and
  /// neighbours across it are none.
  virtual float thickness() const { return std::numeric_limits<float>::infinity(); }
  /// The least way through any part of the solid (m), thickness() included: no move may pass through it
  /// unseen, though what lies behind does count.
  virtual float thinnestPart() const { return thickness(); }
  /// Whether the way from one point of the fluid to another passes through the solid; then the unit normal
  /// where it enters, and how far along the way that is, in [0, 1]. Only for a solid with a finite
  /// thinnestPart().
  virtual bool crosses(const Vec3f& /*from*/, const Vec3f& /*to*/, Vec3f& /*normal*/,
                       float& /*entry*/) const {
    return false;
  }

  /// Whether the wall is made of planes, and how they combine.
  virtual bool planar() const { return false; }
  virtual PieceRule pieceRule() const { return PieceRule::fluidInsideAll; }
  /// Appends the planar pieces whose plane is nearer than `reach` to p, or nothing where the solid is out of
  /// reach. A curved wall has one: the tangent plane at its nearest point.
  virtual void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const;

  /// The finite extent, empty for a surface without one.
  virtual Bounds bounds() const = 0;
  /// Lines that show the wall; `scene` bounds what an infinite wall draws.
  virtual void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const = 0;
  /// The wall as a mesh to shade; empty where lines show it well enough.
  virtual WallMesh mesh() const { return {}; }
  /// Appends the balls that a SLIM surface is made of.
  virtual void drawnNodes(std::vector<WallNode>&) const {}
  /// Non-null for a box that holds the fluid.
  virtual const BoxGeometry* tank() const { return nullptr; }
};

/// Names for the scene's "shape" key, in the order of makeSurface's index.
std::span<const std::string_view> surfaceShapes();
std::unique_ptr<Surface> makeSurface(int shape);

}  // namespace migiwa
