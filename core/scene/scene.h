// A scene as a value, with the limits of what can be run.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/drain.h"
#include "core/scene/gauge.h"
#include "core/scene/sources.h"
#include "core/solver/effect.h"
#include "core/solver/parameters.h"
#include "core/walls/surface.h"

namespace migiwa {

// The particle quantities that pictures can be coloured by.

enum class ColorField { density, speed, gamma, lambda, neighbours, pressure };
inline constexpr std::array<std::string_view, 6> kColorFieldNames{"density", "speed",      "gamma",
                                                                  "lambda",  "neighbours", "pressure"};

// A scene as a value: everything a simulation and a picture need, validated, free of JSON. Surfaces, sources
// and effects are shared and never change after reading, so a scene can be copied and handed around.

struct Camera {
  Vec3d eye{3, 2, 5};     ///< (unit: m)
  Vec3d target{0, 0, 0};  ///< (unit: m)
  Vec3d up{0, 1, 0};
  double fovDegrees = 40;  ///< vertical field of view (unit: degrees, range: [1, 120])

  bool operator==(const Camera&) const = default;
};

enum class Axis { x, y, z };
inline constexpr std::array<std::string_view, 3> kAxisNames{"x", "y", "z"};

/// What lies beyond the plane towards the camera is cut away.
struct ClipPlane {
  bool enabled = false;
  Axis axis = Axis::z;
  double at = 0;  ///< (unit: m)

  bool operator==(const ClipPlane&) const = default;
};

/// What a wall is made of in a ray-traced picture.
enum class WallMaterial {
  automatic,  ///< glass what holds the fluid, matt what stands in it
  glass,
  matt,
  hidden  ///< not shown: water that touches it looks as if nothing did
};
inline constexpr std::array<std::string_view, 4> kWallMaterialNames{"auto", "glass", "matt", "hidden"};

/// How ray-traced pictures show water and walls.
struct Look {
  Vec3d waterColor{0.45, 0.8, 0.88};  ///< of white light that has gone through one waterDepth of water
  double waterDepth = 1;              ///< (unit: m)
  std::vector<WallMaterial> walls;    ///< in the order of the surfaces; the rest is automatic
  Vec3d mattColor{0.7, 0.68, 0.65};   ///< share of light that matt walls throw back
  double lightTurn = 0;               ///< of the light about the up axis (unit: degrees, range: [-360, 360])

  bool operator==(const Look&) const = default;
};

struct View {
  Camera camera;
  ClipPlane clip;
  bool nodes = false;  ///< SLIM walls as the discs of their nodes instead of their surface
  ColorField color = ColorField::density;
  bool hasColorRange = false;
  std::array<double, 2> colorRange{
      0, 1};  ///< ends of the colour map, in the field's unit; used if hasColorRange
  Look look;

  bool operator==(const View&) const = default;
};

/// Where particles are followed; what leaves it is removed and counted.
struct Domain {
  bool given = false;         ///< else it follows from the scene, see Scene::domainBounds()
  Vec3d min = Vec3d::Zero();  ///< (unit: m)
  Vec3d max = Vec3d::Ones();  ///< (unit: m)
};

struct Scene {
  std::filesystem::path file;  ///< where it was read from
  std::string name;
  std::string description;
  double duration = 4;            ///< (unit: s)
  double particleSpacing = 0.05;  ///< (unit: m)
  /// What all positions here are relative to, in the coordinates of the file: zero but in a scene so far from
  /// zero that floats would miss parts of a spacing (unit: m).
  Vec3d origin = Vec3d::Zero();
  Vec3d gravity{0, -9.81, 0};  ///< (unit: m/s^2)
  std::vector<std::shared_ptr<const FluidSource>> fluid;
  std::vector<Emitter> emitters;
  std::vector<Drain> drains;
  std::vector<Gauge> gauges;
  Domain domain;
  std::vector<std::shared_ptr<const Surface>> surfaces;
  BoundaryParameters boundary;
  SolverParameters solver;
  std::vector<NamedEffect> effects;
  View view;
  std::vector<std::string> warnings;  ///< what is valid and probably not meant, one sentence each

  std::string stem() const { return file.stem().string(); }
  double supportRadius() const { return solver.supportRatio * particleSpacing; }
  /// Extent of fluid and finite walls, wherever they are within the duration.
  Bounds bounds() const;
  /// Where particles are followed: what `bounds` says, else ten of the scene's diagonals beyond its extent,
  /// far enough for any splash to come back. Empty, which is everywhere, where that has no walls or no
  /// extent.
  Bounds domainBounds() const;
};

// Whether a scene's particles have room on this machine.

/// Memory that a particle takes while it is simulated, all arrays and neighbour lists together (bytes).
inline constexpr double kBytesPerParticle = 600;

/// Particles that a simulation has at most, whatever the memory: neighbours are listed by their offsets in
/// bytes, of 16 a particle, in 32 bits; one place is for the ghost.
inline constexpr double kLargestCount = 268435455;

/// A positive number for people, to two digits up or three down; no other digits than it needs.
double shownRoundedUp(double value);
double shownRoundedDown(double value);

/// Particles that fit into `memory` (bytes).
double mostParticles(double memory);

/// Particles of all fluid sources, and of all emitters until `time` (s), at most, at any spacing (m).
double particleCount(const Scene& scene, double spacing, double time);
/// The same at the scene's spacing within its duration.
double particleCount(const Scene& scene);

/// "expected ..., found ..." with the spacing that would do, or nothing when the particles fit into `memory`
/// (bytes). `count` says how many there are at a spacing (m).
std::optional<std::string> tooManyParticles(const std::function<double(double)>& count, double spacing,
                                            double memory);
/// The same for so many particles that go with the spacing to the power of -3.
std::optional<std::string> tooManyParticles(double particles, double spacing, double memory);

// The camera of a scene that names none.

/// Sees all of `bounds` (m) from the front, a little from above and from the right; up is against gravity
/// (m/s^2).
Camera defaultCamera(const Bounds& bounds, const Vec3d& gravity);

// Whether a scene can be run to a given time at all: in steps that somebody can wait for, and with particles
// that have room. Both are asked before anything is made, of the time that the run really ends at.

/// Steps that a run has at most. At a microsecond a step, which no machine reaches, they take a quarter of an
/// hour for a handful of particles, and years for a scene that is worth looking at.
inline constexpr double kMostSteps = 1e9;

/// Steps of a run to `time` (s), at least: the CFL rule may ask for more.
double fewestSteps(const SolverParameters& solver, double time);

/// "expected ..., found ..." for a time_step of which `duration` (s) has too many, or nothing.
std::optional<std::string> tooShortStep(const SolverParameters& solver, double duration);

/// "expected ..., found ..." for an end `until` (s) that the scene cannot be run to, or nothing: too many
/// steps, or emitters that by then have given more particles than fit into `memory` (bytes).
std::optional<std::string> tooLateAnEnd(const Scene& scene, double until, double memory);

/// Throws InputError at `option` for such an end and the memory that is available.
void requireReachable(const Scene& scene, double until, const std::string& option);

}  // namespace migiwa
