// The planar walls in reach of a point as half-spaces. The fluid is the intersection of the tanks'
// half-spaces less the blocks, each an intersection of its own:
//   gamma = P(tanks) - sum over blocks of P(tanks and block),
// where P is the part of the kernel inside all half-spaces of a set. Blocks do not overlap each other. A
// block thinner than the support radius reaches back without end behind the faces visible from the point:
// what it hides does not count. That is exact but near its rim.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/walls/boundary.h"

namespace migiwa {

/// Half-space with its unit normal pointing inside; e > 0 where the point is inside, over the support radius.
struct HalfSpace {
  Vec3f normal;
  float e;
};

class HalfSpaces {
 public:
  const std::vector<HalfSpace>& tanks() const { return tanks_; }
  /// For an intersection of one's own.
  std::vector<HalfSpace>& tanks() { return tanks_; }
  /// Each with the tanks' half-spaces.
  std::span<const std::vector<HalfSpace>> blocks() const { return std::span(blocks_).first(count_); }
  /// Takes the planar pieces of the surfaces that are nearer than the support radius. Returns whether the rim
  /// of a thin block is in reach, where what it hides is no intersection of half-spaces; with `untilRim` it
  /// then leaves out what else there is.
  bool collect(const Boundary& boundary, const Vec3f& p, float supportRadius, bool untilRim = false);

 private:
  /// Whether its rim is in reach, if it is thin.
  bool addBlock(bool thin, float inverseSupport);

  std::vector<HalfSpace> tanks_;
  std::vector<std::vector<HalfSpace>> blocks_;  ///< more than there are: their memory stays
  std::size_t count_ = 0;
  // Of one block:
  std::vector<WallPiece> pieces_;
  std::vector<float> own_;  ///< what its faces add to the intersection
};

/// Adds a half-space to an intersection: of two that look the same way, the narrower counts, or coplanar
/// walls would count twice. Returns whether the one added counts.
bool intersect(std::vector<HalfSpace>& set, const HalfSpace& added);

/// The part of a kernel inside one half-space, or between two that face each other.
struct KernelPart {
  float value;     ///< in [0, 1]
  Vec3f gradient;  ///< of the value, times the support radius
  Vec3f axis;      ///< normal of the first half-space
};

/// Splits an intersection into its axes. What two parallel planes take away adds up.
template <class Kernel>
void kernelParts(std::span<const HalfSpace> set, std::vector<KernelPart>& parts) {
  parts.clear();
  for (const HalfSpace& half : set) {
    const float taken = 1 - Kernel::planeGamma(half.e);
    const Vec3f gradient = Kernel::planeGammaSlope(half.e) * half.normal;
    KernelPart* opposite = nullptr;
    for (KernelPart& part : parts)
      if (part.axis.dot(half.normal) < -0.999F) opposite = &part;
    if (opposite == nullptr) {
      parts.push_back({1 - taken, gradient, half.normal});
    } else if (opposite->value > taken) {
      opposite->value -= taken;
      opposite->gradient += gradient;
    } else {
      opposite->value = 0;
      opposite->gradient.setZero();
    }
  }
}

// Walls that are nothing but planes with the fluid inside all of them, such as a box tank: a flat list that
// the inner loops run over without a virtual call.

/// Distances over the support radius: e = normal . p / h + offset, positive in the fluid.
struct FlatPlane {
  Vec3f normal;  ///< unit, into the fluid, over the support radius
  float offset;
  Vec3f unit;  ///< unit, into the fluid
  float at(const Vec3f& p) const { return normal.dot(p) + offset; }
};

class FlatPlanes {
 public:
  /// More than this many are left to a search of what is in reach.
  static constexpr std::size_t kMostPlanes = 64;
  /// Nothing where a surface is curved or a block, or where two planes are so nearly one that which of them
  /// counts depends on the place.
  static std::optional<FlatPlanes> of(const Boundary& boundary, float supportRadius);

  std::span<const FlatPlane> planes() const { return planes_; }
  /// Parallel planes that face each other are one axis; -1: there is no second.
  struct Axis {
    int first, second;
  };
  std::span<const Axis> axes() const { return axes_; }
  /// Whether all axes are at right angles.
  bool rightAngled() const { return oblique_.empty(); }
  /// Whether two axes that are not at right angles are both in reach of p.
  bool obliqueAt(const Vec3f& p) const;
  /// The planes in reach of p as half-spaces.
  void inReach(const Vec3f& p, std::vector<HalfSpace>& set) const;

 private:
  std::vector<FlatPlane> planes_;
  std::vector<Axis> axes_;
  std::vector<std::pair<int, int>> oblique_;
};

// Convex polygons, and what half-spaces leave of them.

/// A flat convex polygon.
struct Polygon {
  /// What is cut gains a corner with every cut; one that has as many is cut no more.
  static constexpr int kMost = 24;

  std::array<Vec3f, kMost> corners;
  int count = 0;

  void add(const Vec3f& corner) { corners[static_cast<std::size_t>(count++)] = corner; }
  bool empty() const { return count < 3; }
  const Vec3f& corner(int k) const { return corners[static_cast<std::size_t>(k == count ? 0 : k)]; }
};

/// Where normal . y + offset >= 0.
struct CutPlane {
  Vec3f normal;
  float offset = 0;
  float at(const Vec3f& y) const { return normal.dot(y) + offset; }
};

/// Whether the plane passes through the polygon, or which side all of it lies on.
enum class PlaneSide { inside, across, outside };
PlaneSide sideOf(const Polygon& polygon, const CutPlane& plane);

/// The part of a polygon on the inside of a plane; empty where there is none.
void clip(Polygon& polygon, const CutPlane& plane);

/// What a point at the origin sees through a polygon that faces it: the half-spaces that bound that cone.
class ViewCone {
 public:
  /// `normal`: unit, to the side of the origin, which is `distance` from the plane.
  ViewCone(const Polygon& polygon, const Vec3f& normal, float distance);

  /// Takes the part of `polygon` that is in the cone and behind its polygon out of it: what is left is
  /// appended in pieces. False, and nothing appended, where there is no such part.
  bool subtractFrom(const Polygon& polygon, std::vector<Polygon>& left) const;

 private:
  std::array<CutPlane, Polygon::kMost + 1> planes_;
  int count_ = 0;
};

}  // namespace migiwa
