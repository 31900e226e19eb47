// A wall: what every shape answers, and what it is asked with.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/base/fields.h"
#include "core/base/math.h"
#include "core/slim/points.h"
#include "core/walls/upright.h"

namespace migiwa {

// A fixed set of unit vectors spread evenly over the sphere, coordinate by coordinate so that loops over it
// vectorise.

struct Directions {
  std::vector<float> x, y, z;
  std::size_t size() const { return x.size(); }
};

/// A Fibonacci set: `count` points on a spiral, equal areas to each.
Directions fibonacciDirections(int count);

// How a wall moves, as scenes write it: at a constant velocity, in a turn about an axis, to and fro, or by
// keyframes; what is named adds up. A motion is a function of time alone, so nothing of it needs saving.

/// A rigid move: a rotation and a translation after it (m). It is Eigen::Isometry3d, of <Eigen/Geometry>.
using Pose = Eigen::Transform<double, 3, Eigen::Isometry>;

/// Where a wall is at a time, relative to where the scene puts it.
struct Keyframe {
  double time = 0;                  ///< (unit: s)
  Vec3d translate = Vec3d::Zero();  ///< (unit: m)
  double degrees = 0;               ///< about the motion's axis (unit: degrees)
};

/// How places between keyframes follow.
enum class Interpolation {
  smooth,  ///< at rest at each keyframe: 3 s^2 - 2 s^3 of the way
  linear   ///< at a constant velocity from one to the next
};

struct Motion {
  Vec3d velocity = Vec3d::Zero();  ///< (unit: m/s)

  bool turns = false;           ///< whether there is an axis
  Vec3d axis = Vec3d::UnitY();  ///< of every turn, right-handed; it moves along with the wall
  Vec3d point = Vec3d::Zero();  ///< of the axis (unit: m)
  double degreesPerSecond = 0;  ///< (unit: degrees/s)

  bool oscillates = false;
  Vec3d amplitude = Vec3d::Zero();  ///< of the sway (unit: m)
  double swing = 0;                 ///< amplitude of the turn about the axis (unit: degrees)
  double period = 1;                ///< (unit: s)

  double start = 0;   ///< velocity, turn and oscillation begin (unit: s)
  double stop = 1e6;  ///< and end, and the wall stays where it is then (unit: s)

  std::vector<Keyframe> keyframes;
  Interpolation interpolation = Interpolation::smooth;

  /// Visits the keys of the scene's object "motion", then checks what follows from them.
  void describe(FieldVisitor& visitor);
  void describe(FieldWriter& visitor) const;
  /// From where the scene puts the wall to where it is at `time` (s).
  Pose at(double time) const;
  /// Whether two walls with these motions never move relative to each other.
  bool sameAs(const Motion& other) const;
};

// What pictures show of walls: plain data, in the scene's space (m).

struct LineSegment {
  Vec3f from, to;
};

/// A wall to be shaded. Seen from the fluid its triangles run counter-clockwise.
struct WallMesh {
  TriangleMesh surface;
  std::vector<Vec3f> normals;  ///< at each vertex, unit, into the fluid
  bool vessel = false;         ///< holds the fluid, so that its near side must not hide what is within
};

/// The core of a ball of a SLIM surface, as a disc that touches the surface.
struct WallNode {
  Vec3f centre;      ///< on the surface (m)
  Vec3f normal;      ///< unit, into the fluid
  float ballRadius;  ///< (m)
  float discRadius;  ///< (m)
  bool vessel;       ///< as of its WallMesh
};

struct WallDrawing {
  std::vector<LineSegment> lines;
  std::vector<WallMesh> meshes;
  std::vector<WallNode> nodes;
};

// One solid wall: where it is, and nothing of gamma. A shape is one file that implements this interface and
// one line in core/walls/boundary.cpp. Distances are metres, positive in the fluid; normals are unit vectors
// into the fluid.

/// A planar piece of a wall as seen from one point.
struct WallPiece {
  Vec3f normal;         ///< unit, into the fluid
  float planeDistance;  ///< signed distance of the point to the piece's plane (m)
  Vec3f foot;           ///< closest point of the piece itself
};

/// A flat convex piece of a wall, to its own borders.
struct WallFacet {
  std::array<Vec3f, 4> corners;  ///< (m), counter-clockwise seen from where the normal points
  int count;                     ///< of corners: 3 or 4
  Vec3f normal;                  ///< unit, into the fluid; of a sheet, to the side of the point
  bool hides;                    ///< belongs to what is so thin that nothing behind it counts
  bool alone;                    ///< hides no other facet of its wall that faces the same point
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

/// The solid of a wall that is a plane, a box or a sphere, or what that leaves of space.
struct ClosedForm {
  enum class Kind { plane, box, sphere };

  Kind kind = Kind::plane;
  Vec3d center = Vec3d::Zero();  ///< of a plane any point of it (m)
  Eigen::Matrix3d axes =
      Eigen::Matrix3d::Identity();    ///< columns: unit; of a plane the last one points into the fluid
  Vec3d halfExtents = Vec3d::Zero();  ///< of a sphere its radius, three times (m)
  bool fluidInside = false;
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
  /// The wall as particles of this support radius (m) meet it: which of its parts are thin depends on that.
  /// Null where it is this one.
  virtual std::shared_ptr<const Surface> forSupport(float /*supportRadius*/) const { return nullptr; }

  /// How far (m) the wall near p may be from the shape that it stands for, as far as it knows: 0 where it is
  /// what it says.
  virtual float statedError(const Vec3f& /*p*/) const { return 0; }
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
  /// thinner than the support radius does not count: gamma takes only the fluid visible from the point, and
  /// neighbours across it are none.
  virtual float thickness() const { return std::numeric_limits<float>::infinity(); }
  /// Whether rays that enter the solid may go on in the fluid behind it: nowhere behind one that is thinner
  /// than the support radius (m) as a whole, elsewhere where exits() says so.
  virtual bool passable(float supportRadius) const { return reentrant() && thickness() >= supportRadius; }
  /// Whether a solid, or a part of one, that is thinner than the support radius comes nearer than `reach` (m)
  /// to p.
  virtual bool thinWithin(const Vec3f& p, float reach, float supportRadius) const {
    Vec3f ignored;
    return thickness() < supportRadius && distance(p, ignored) < reach;
  }
  /// Whether the solid is convex: then two points on the fluid's side of one of its tangent planes see each
  /// other.
  virtual bool convex() const { return false; }
  /// Whether what is that thin keeps two points of the fluid from being neighbours.
  virtual bool hides(const Vec3f& from, const Vec3f& to) const {
    Vec3f normal;
    float entry = 0;
    return crosses(from, to, normal, entry);
  }
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

  /// Whether the wall is made of flat pieces that facets() has.
  virtual bool faceted() const { return false; }
  /// Appends the facets that come nearer than the support radius (m) to p, and some more. Where all of the
  /// wall hides what is behind it, those that face away from p may be left out.
  virtual void facets(const Vec3f& /*p*/, float /*supportRadius*/, std::vector<WallFacet>& /*out*/) const {}

  /// Appends a closed mesh, its front outwards, around what the shape encloses, be that fluid or solid: exact
  /// but where it is round, and there within a three-thousandth of its radius. False where it encloses
  /// nothing.
  virtual bool enclosed(TriangleMesh& /*mesh*/) const { return false; }

  /// Nothing for other shapes.
  virtual std::optional<ClosedForm> closedForm() const { return std::nullopt; }
  // Null for other walls.
  const UprightBlock* uprightBlock() const { return block_ ? &*block_ : nullptr; }
  const UprightVessel* uprightVessel() const { return vessel_ ? &*vessel_ : nullptr; }

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

 protected:
  std::optional<UprightBlock> block_;
  std::optional<UprightVessel> vessel_;
};

/// Moves p along the normals of a surface until it is at `margin` (m), or midway between two of its parts
/// that leave no room. Returns whether it moved.
bool projectAlongNormals(const Surface& surface, Vec3f& p, float margin);

/// A surface that leaves to another what it does not know better.
class StandIn : public Surface {
 public:
  float distance(const Vec3f& p, Vec3f& normal) const override { return shape_->distance(p, normal); }
  bool project(Vec3f& p, float margin) const override { return shape_->project(p, margin); }
  void otherWaysOut(const Vec3f& p, float margin, std::vector<Vec3f>& out) const override {
    shape_->otherWaysOut(p, margin, out);
  }
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override {
    shape_->firstHits(origin, directions, hits);
  }
  bool steadyDistance() const override { return shape_->steadyDistance(); }
  float statedError(const Vec3f& p) const override { return shape_->statedError(p); }
  std::optional<double> fitError() const override { return shape_->fitError(); }
  bool reentrant() const override { return shape_->reentrant(); }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override {
    shape_->exits(origin, directions, exits);
  }
  float thickness() const override { return shape_->thickness(); }
  bool passable(float supportRadius) const override { return shape_->passable(supportRadius); }
  bool thinWithin(const Vec3f& p, float reach, float supportRadius) const override {
    return shape_->thinWithin(p, reach, supportRadius);
  }
  bool convex() const override { return shape_->convex(); }
  bool hides(const Vec3f& from, const Vec3f& to) const override { return shape_->hides(from, to); }
  float thinnestPart() const override { return shape_->thinnestPart(); }
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override {
    return shape_->crosses(from, to, normal, entry);
  }
  bool planar() const override { return shape_->planar(); }
  PieceRule pieceRule() const override { return shape_->pieceRule(); }
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override {
    shape_->pieces(p, reach, out);
  }
  bool faceted() const override { return shape_->faceted(); }
  void facets(const Vec3f& p, float supportRadius, std::vector<WallFacet>& out) const override {
    shape_->facets(p, supportRadius, out);
  }
  Bounds bounds() const override { return shape_ != nullptr ? shape_->bounds() : Bounds{}; }
  void wireframe(const Bounds& scene, std::vector<LineSegment>& out) const override {
    shape_->wireframe(scene, out);
  }
  WallMesh mesh() const override { return shape_->mesh(); }
  void drawnNodes(std::vector<WallNode>& out) const override { shape_->drawnNodes(out); }
  const BoxGeometry* tank() const override { return shape_->tank(); }
  bool enclosed(TriangleMesh& mesh) const override { return shape_->enclosed(mesh); }
  std::optional<ClosedForm> closedForm() const override { return shape_->closedForm(); }

 protected:
  std::shared_ptr<const Surface> shape_;  ///< null: not read yet
};

/// A shape that knows its signed distance and its extent, which is finite, and nothing else: rays go ahead by
/// distances, as far as the wall is at least. Its distances are those of a closed solid; too short ones cost
/// time, too long ones miss the wall. Pictures show what `wireframe` or `mesh` draw: nothing, unless they are
/// overridden.
class DistanceSurface : public Surface {
 public:
  /// Distance (m) of p, positive in the fluid. Called from all threads.
  virtual double signedDistance(const Vec3d& p) const = 0;
  /// The same with its normal by central differences, unless a shape knows it better.
  float distance(const Vec3f& p, Vec3f& normal) const override;
  bool costlyDistance() const override { return true; }
  bool project(Vec3f& p, float margin) const override { return projectAlongNormals(*this, p, margin); }
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  void wireframe(const Bounds&, std::vector<LineSegment>&) const override {}
};

/// Names for the scene's "shape" key, in the order of makeSurface's index.
std::span<const std::string_view> surfaceShapes();
std::unique_ptr<Surface> makeSurface(int shape);
/// Adds a shape from outside the library: from then on the surfaces of a scene may name it. Call it before
/// the first scene is read. Throws std::invalid_argument for a name that is taken or no lower-case word.
void registerSurface(const std::string& name, std::function<std::unique_ptr<Surface>()> make);
template <class Shape>
void registerSurface(const std::string& name) {
  registerSurface(name, [] { return std::make_unique<Shape>(); });
}

// First hits of rays with one plane: what planes and the faces of boxes share.

/// For an origin at `distance` (m) on the fluid side of a plane with the given unit normal into the fluid.
inline void hitPlane(const Vec3f& normal, float distance, const Directions& directions,
                     std::span<float> hits) {
  const float nx = normal.x(), ny = normal.y(), nz = normal.z(), d = std::max(distance, 1e-9F);
  const float *x = directions.x.data(), *y = directions.y.data(), *z = directions.z.data();
  float* hit = hits.data();
  for (std::size_t k = 0; k < hits.size(); ++k) {
    // A ray that runs along the plane or away from it gets a hit beyond every reach, also from the plane
    // itself.
    const float towards = std::max(-(nx * x[k] + ny * y[k] + nz * z[k]), 1e-12F);
    hit[k] = std::min(hit[k], d / towards);
  }
}

}  // namespace migiwa
