// Where fluid comes from: sources that are filled at the start, and emitters.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/base/math.h"
#include "core/slim/points.h"

namespace migiwa {

// How fluid moves at the start. A turn and waves add to the source's velocity.

/// A rigid turn about an axis.
struct Spin {
  bool given = false;
  Vec3d axis = Vec3d::UnitY();  ///< any length but zero
  Vec3d point = Vec3d::Zero();  ///< on the axis (unit: m)
  double degreesPerSecond = 0;  ///< right-handed (unit: degrees/s)
};

/// velocity * cos(wave . (x - point)).
struct VelocityWave {
  Vec3d velocity = Vec3d::Zero();  ///< (unit: m/s)
  Vec3d wave = Vec3d::Zero();      ///< wave vector: 2 pi over the wavelength (unit: 1/m)
  Vec3d point = Vec3d::Zero();     ///< on a crest (unit: m)
};

// A region that is filled with fluid at the start. A source is one file that implements this interface and
// one line in core/scene/sources.cpp.

class FluidSource {
 public:
  virtual ~FluidSource() = default;

  /// Visits the shape's own fields of the scene file's object, then checks and prepares what follows from
  /// them.
  virtual void describe(FieldVisitor& visitor) = 0;
  /// Visits the same fields, and changes nothing.
  virtual void describe(FieldWriter& visitor) const = 0;
  /// How many particles fill() makes at most, without making them.
  virtual double count(double spacing) const = 0;
  /// Appends the centres of a cell-centred lattice of the given spacing (m) that lie in the region.
  virtual void fill(double spacing, std::vector<Vec3d>& out) const = 0;
  virtual Bounds bounds() const = 0;
  /// The region where it is an upright box, whose lattice can go on from that of another one that it touches;
  /// empty for any other.
  virtual Bounds block() const { return {}; }
  /// Lengths (m) that stay empty because no whole cell has room there, along the axes of its lattice.
  virtual Vec3d leftOver(double /*spacing*/) const { return Vec3d::Zero(); }

  /// Visits the fields of how the fluid moves at the start.
  template <class Visitor>
  static void describeMotion(Visitor& visitor, Visited<Visitor, FluidSource>& self);
  /// Velocity (m/s) of the fluid at p at the start.
  Vec3d velocityAt(const Vec3d& p) const;
  /// A bound for the speed (m/s) of all of the fluid at the start.
  double largestSpeed() const;

  /// Fields that every source has.
  Vec3d velocity = Vec3d::Zero();  ///< initial velocity (unit: m/s)
  Spin spin;
  std::vector<VelocityWave> velocityWaves;
  /// Leave out centres that are less than half a spacing inside the fluid side, and those that are nearer
  /// than 0.9 spacings to a particle of an earlier source.
  bool trim = true;

 protected:
  /// What the shape itself adds to the velocity (m/s) at p, and a bound for its length.
  virtual Vec3d ownVelocity(const Vec3d& /*p*/) const { return Vec3d::Zero(); }
  virtual double ownSpeed() const { return 0; }
};

/// Names for the scene's "shape" key, in the order of makeFluidSource's index.
std::span<const std::string_view> fluidShapes();
std::unique_ptr<FluidSource> makeFluidSource(int shape);

// A box full of fluid, upright or turned about its centre.

/// The lattice begins at `min`, so that a box on the floor of a tank lies on it whatever its lengths are, and
/// has as many whole cells along each axis of the box as there is room for before `max`.
class BoxSource final : public FluidSource {
 public:
  BoxSource() = default;
  BoxSource(const Vec3d& min, const Vec3d& max, const Rotation& rotation = {});

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  double count(double spacing) const override;
  void fill(double spacing, std::vector<Vec3d>& out) const override;
  Bounds bounds() const override;
  Bounds block() const override;
  Vec3d leftOver(double spacing) const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, BoxSource>& self);
  Vec3d toWorld(const Vec3d& p) const;

  Vec3d min_ = Vec3d::Zero();
  Vec3d max_ = Vec3d::Ones();
  Rotation rotation_;
};

// Sources that are filled together. Upright boxes that touch or overlap share a lattice along the axis along
// which they follow each other: each goes on where a whole number of cells of the one below ends, so that no
// gap is left between them. Where their places are whole cells apart, nothing changes.

class SourceUnion {
 public:
  /// `spacing` in m.
  SourceUnion(std::vector<std::shared_ptr<const FluidSource>> sources, double spacing);

  /// Appends the centres of a source, before any of them is left out for a wall or another source. Cells of a
  /// box that begin before its `min` are filled where another box is below them.
  void fill(std::size_t source, std::vector<Vec3d>& out) const;
  /// What of a box stays empty, or is filled beyond it, with its share; empty where neither is the case.
  std::string remark(std::size_t source) const;

 private:
  double startAlong(int axis, std::size_t source) const;
  bool anyHolds(const Vec3d& p, std::size_t except) const;

  std::vector<std::shared_ptr<const FluidSource>> sources_;
  std::vector<Bounds> blocks_;  ///< empty for a source that is no upright box
  std::vector<Vec3d> starts_;   ///< where the lattices of the blocks begin (m)
  double spacing_;
};

/// What decimal numbers miss by in a double, in cells.
inline constexpr double kCellTolerance = 1e-6;

/// How many whole cells have room in a length (m), give or take the tolerance.
double wholeCells(double length, double spacing);

// A ball of fluid.

/// The lattice has round(diameter / spacing) cells along each axis, centred on the ball; the cells whose
/// centres lie in the ball are filled.
class SphereSource final : public FluidSource {
 public:
  SphereSource() = default;
  SphereSource(const Vec3d& center, double radius) : center_(center), radius_(radius) {}

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  double count(double spacing) const override;
  void fill(double spacing, std::vector<Vec3d>& out) const override;
  Bounds bounds() const override;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, SphereSource>& self);
  Vec3d center_ = Vec3d::Zero();
  double radius_ = 1;
};

// An upright box of water whose surface is not level.

enum class WaveForm { cosine, solitary };
inline constexpr std::array<std::string_view, 2> kWaveFormNames{"cosine", "solitary"};

/// Water over the floor min.y up to the still level max.y plus eta(x); y points up. With d = max.y - min.y,
/// X = x - crest and the height H:
///   cosine    eta = H cos(2 pi X / wavelength)
///   solitary  eta = H sech^2(sqrt(3 H / (4 d^3)) X) (Boussinesq 1872), which travels at sqrt(g (d + H))
/// A form that travels along x at the speed c without changing has, by continuity, the mean velocity
/// u = c eta / (d + eta) over the depth, and at the height y over the floor v = -y du/dx. The lattice is that
/// of the box, and holds the cells whose centres are below the surface.
class WaveSource final : public FluidSource {
 public:
  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  double count(double spacing) const override;
  void fill(double spacing, std::vector<Vec3d>& out) const override;
  Bounds bounds() const override;

 protected:
  Vec3d ownVelocity(const Vec3d& p) const override;
  double ownSpeed() const override;

 private:
  struct Surface {
    double eta, slope;  ///< (m, 1)
  };
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, WaveSource>& self);
  Surface surfaceAt(double x) const;

  Vec3d min_ = Vec3d::Zero(), max_ = Vec3d::Ones();  ///< (m)
  WaveForm form_ = WaveForm::cosine;
  double height_ = 0.1, wavelength_ = 1, crest_ = 0;  ///< (m)
  double speed_ = 0;                                  ///< (m/s)
};

// The inside of a closed mesh, full of fluid: the union of its parts, less those within others that face
// inwards.

/// The lattice has round(length / spacing) cells along each axis of the mesh's bounds, centred on them or
/// moved by quarters of a cell; the cells at whose centres the mesh's winding number is 1 or more are filled.
class MeshSource final : public FluidSource {
 public:
  MeshSource() = default;
  explicit MeshSource(TriangleMesh mesh);

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  double count(double spacing) const override;
  void fill(double spacing, std::vector<Vec3d>& out) const override;
  Bounds bounds() const override { return mesh_.bounds(); }

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, MeshSource>& self);
  void measure();

  FileName file_;
  Transform transform_;
  TriangleMesh mesh_;
  double volume_ = 0, area_ = 0;  ///< (m^3, m^2)
};

// A mouth that gives fluid while the simulation runs: a faucet, a nozzle, a spring. It gives whole layers of
// particles, one behind the other, so that the density is right from the mouth on and the volume follows the
// rate to within a layer.

enum class MouthShape { disc, rectangle };
inline constexpr std::array<std::string_view, 2> kMouthShapeNames{"disc", "rectangle"};

struct Emitter {
  MouthShape shape = MouthShape::disc;
  Vec3d center = Vec3d::Zero();          ///< of the mouth (unit: m)
  double radius = 0.1;                   ///< of a disc (unit: m)
  std::array<double, 2> size{0.2, 0.2};  ///< of a rectangle, along its x axis and across (unit: m)
  Vec3d xAxis = Vec3d::Zero();           ///< of a rectangle; zero: any
  Vec3d direction = -Vec3d::UnitY();     ///< in which the fluid leaves; any length but zero
  double speed = 0;                      ///< of the fluid at the mouth (unit: m/s); zero: by the rate
  double rate = 0;                       ///< volume in a second (unit: m^3/s); zero: by the speed
  double start = 0;                      ///< (unit: s)
  double stop = 1e6;                     ///< (unit: s)
  int particles = 100000;                ///< that it gives at most

  /// Visits the fields of the scene file's object. `spacing` (m) is the particles'; zero: not known.
  void describe(FieldVisitor& visitor, double spacing);
  void describe(FieldWriter& visitor) const;

  double area() const;  ///< (m^2)
  /// Speed of the fluid at the mouth (m/s), whichever of speed and rate is given.
  double mouthSpeed() const { return rate > 0 ? rate / area() : speed; }
  /// Particles that it gives up to `time` (s), at most: a layer more than the rate asks for.
  double count(double spacing, double time) const;
  Bounds bounds() const;
  /// Corners of the mouth's rim in their order, for pictures; those of a disc lie on its circle.
  std::vector<Vec3d> outline() const;

 private:
  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, Emitter>& self);
  void check(FieldVisitor& visitor, double spacing);
};

/// A layer of particles in the mouth.
struct MouthLayer {
  std::vector<Vec3d> places;  ///< (m)
  double thickness = 0;       ///< distance to the next layer (m): area * thickness holds the layer's volume
};
MouthLayer mouthLayer(const Emitter& emitter, double spacing);

// The cells of a lattice whose centres lie in a closed mesh. The cost follows the mesh: only columns of cells
// that it crosses are looked at, and of each only the cells within, however much of its bounding box is
// empty.

/// What filling took, for tests of its cost.
struct MeshFillWork {
  std::int64_t lines = 0;    ///< rows of columns that were cut with a triangle
  std::int64_t columns = 0;  ///< columns that were tested against a triangle
  std::int64_t cells = 0;    ///< cells that were filled
  std::size_t mostHeld = 0;  ///< crossings and cells that were held at once beside the result
};

/// Appends the centres of the cells at which the winding number of the mesh, whose triangles face outwards,
/// is 1 or more, by z, then y, then x. The lattice has round(length / spacing) cells along each axis of the
/// mesh's bounds, centred on them; or, where it is of fewer than a million cells and that misses the volume
/// by more than 1 %, it is moved by quarters of a cell, so that it comes nearer. `spacing` in m; the lattice
/// must have fewer than 2^53 cells along each axis. Returns the work of the filling itself, without that of
/// trying such moves.
MeshFillWork fillMesh(const TriangleMesh& mesh, double spacing, std::vector<Vec3d>& out);

}  // namespace migiwa
