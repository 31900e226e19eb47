// What a ray-traced picture shows: water, bodies, ground, sky and light, and which medium is where.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "app/raytrace/bodies.h"
#include "app/raytrace/embree.h"
#include "app/raytrace/optics.h"
#include "core/scene/scene.h"
#include "core/surface/mesh.h"
#include "core/walls/boundary.h"

namespace migiwa {

/// Where light may go: in air, in water, or in a body of glass.
struct Place {
  Medium medium = Medium::air;
  int body = -1;  ///< of glass
};

/// What a ray comes to.
struct Event {
  enum class Kind {
    sky,       ///< nothing any more
    light,     ///< the area light
    matt,      ///< a surface that throws light back in all directions
    interface  ///< a smooth one between two media
  };

  Kind kind = Kind::sky;
  float distance = 0;  ///< (m)
  Vec3f point = Vec3f::Zero();
  Vec3f normal = Vec3f::UnitY();   ///< unit, against the ray
  Vec3f shading = Vec3f::UnitY();  ///< unit, the same but smooth across triangles
  Medium before = Medium::air;  ///< of the side that the ray comes from, by what is known of this place alone
  Place beyond;                 ///< of the other side, for an interface
  bool byLabel = false;         ///< `beyond` is fluid by the label of the wall
  bool meshed = false;          ///< on triangles: rays start a little off it
  Vec3f albedo = Vec3f::Ones();  ///< of a matt surface
  float haze = 0;                ///< share of the horizon in what is seen of the ground, in [0, 1]
};

/// The usual light, or for tests: the same from everywhere, and glass that takes none.
enum class Surround { studio, furnace };

/// All that pictures of one moment are made of.
struct StageContent {
  const Scene* scene = nullptr;
  const Boundary* walls = nullptr;  ///< where they are at the moment
  const SurfaceMesh* water = nullptr;
  Surround surround = Surround::studio;
  bool ground = true;
};

class Stage {
 public:
  explicit Stage(const StageContent& content);

  /// What a ray from `origin` along `direction` (unit), which is at `place`, comes to.
  Event next(const Vec3f& origin, const Vec3f& direction, const Place& place) const;
  /// Whether anything is in the way of light through air.
  bool blocked(const Vec3f& origin, const Vec3f& direction, float distance) const;
  /// Where an eye is, but that it may be in water: what it sees first tells.
  Place placeOf(const Vec3f& p) const;

  /// Radiance from beyond everything.
  Vec3f sky(const Vec3f& direction) const;
  /// Share of light that is left after a way through a medium.
  Vec3f transmittance(Medium medium, float distance) const;
  /// How far off a surface of triangles rays start (m).
  float offset() const { return offset_; }
  /// Sizes of the scene, for what has no size of its own (m).
  float extent() const { return extent_; }

  /// The area light: a rectangle that shines to one side.
  struct Light {
    Vec3f center = Vec3f::Zero(), u = Vec3f::Zero(), v = Vec3f::Zero();  ///< from its centre to its edges (m)
    Vec3f normal = Vec3f::UnitY();                                       ///< unit, to where it shines
    Vec3f radiance = Vec3f::Zero();                                      ///< zero: there is none
    float area = 0;                                                      ///< (m^2)
  };
  const Light& light() const { return light_; }

 private:
  /// Of the shells around vessels (m).
  float glassThickness() const { return 0.009F * extent_; }
  void setSurroundings(const StageContent& content);
  void addBodies(const StageContent& content);
  void addWater(const StageContent& content);
  float distanceTo(std::size_t body, const Vec3f& p) const;
  bool showsWet(const Vec3f& p) const;
  float depthBehind(const Vec3f& p) const;
  Medium fluidAt(const Vec3f& p, const BodyHit& hit) const;
  Event inGlass(const Vec3f& origin, const Vec3f& direction, Place place) const;
  void meetWater(const Vec3f& origin, const Vec3f& direction, Medium medium, Event& event) const;
  void meetBodies(const Vec3f& origin, const Vec3f& direction, Medium medium, Event& event) const;
  void meetLight(const Vec3f& origin, const Vec3f& direction, Event& event) const;
  Event matt(const Event& event, int body) const;

  std::vector<std::shared_ptr<const Surface>> surfaces_;
  std::vector<Body> bodies_;            ///< those that are shown, and the ground last
  std::vector<const Surface*> hidden_;  ///< walls that are not shown
  std::vector<const Surface*> shown_;   ///< the walls of bodies_
  bool hasGround_ = false;
  Vec3f up_ = Vec3f::UnitY(), groundPoint_ = Vec3f::Zero();
  TriangleRays water_;  ///< closed: faces to the air, and behind the walls what closes them
  std::vector<Vec3f> normals_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  float extent_ = 1, offset_ = 1e-5F, spacing_ = 0.05F;
  Vec3f waterLoss_ = Vec3f::Zero(), glassLoss_ = Vec3f::Zero();  ///< (1/m)
  Vec3f mattColor_ = Vec3f::Ones();
  Surround surround_ = Surround::studio;
  Light light_;
};

}  // namespace migiwa
