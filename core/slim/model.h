// A SLIM surface that is asked for distances and rays.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/slim/node.h"
#include "core/slim/points.h"

namespace migiwa {

// A SLIM surface ([OBA]): nodes, and a search among them whose cost does not depend on their number. Positive
// distances are on the side that the nodes' normals point to: outside the solid.

class DistanceGrid;

class SlimModel {
 public:
  /// What the nodes' blended polynomials say at one point.
  struct Value {
    float f = 0;                     ///< sum w f_i / sum w (m); not a distance
    float weight = 0;                ///< sum w; 0 where no ball reaches
    Vec3f gradient = Vec3f::Zero();  ///< of f
  };
  /// Where the surface is, seen from a point.
  struct Nearest {
    float distance = 0;             ///< signed (m), positive outside
    Vec3f normal = Vec3f::UnitY();  ///< unit, outwards, at the nearest point of the surface
  };

  /// `closed`: the nodes enclose a solid, so that points far away are inside or outside. `pool` shares the
  /// work of preparing; the result is the same for any number of threads.
  SlimModel(std::vector<SlimNode> nodes, int degree, bool closed, ThreadPool& pool);
  ~SlimModel();
  SlimModel(const SlimModel&) = delete;
  SlimModel& operator=(const SlimModel&) = delete;

  const std::vector<SlimNode>& nodes() const { return nodes_; }
  int degree() const { return degree_; }
  bool closed() const { return closed_; }
  /// Of the surface, give or take a node's radius.
  const Bounds& bounds() const { return bounds_; }
  float largestRadius() const { return largestRadius_; }

  /// The blended polynomials at p.
  Value evaluate(const Vec3f& p) const;

  /// Signed distance and normal. Near the surface (within nearReach()) the foot point is found on the blended
  /// surface itself, to 1e-3 of a node's radius and the square of the distance over the radius of curvature;
  /// beyond, by interpolation in a coarse grid of distances, to about an eighth of its cell.
  Nearest nearest(const Vec3f& p) const;
  /// Signed distance from the coarse grid alone, within coarseError() of the right one around the surface:
  /// what is farther away than anyone asks needs no more.
  float coarseDistance(const Vec3f& p) const;
  float coarseError() const;
  float nearReach() const;

  /// Calls visit(index) for every node whose ball comes nearer than `reach` to p.
  template <class Visit>
  void visitWithin(const Vec3f& p, float reach, const Visit& visit) const;

 private:
  /// A node as evaluation reads it.
  struct Packed {
    float cx, cy, cz, inverseSquare;
    float nx, ny, nz, c0;
    float tx, ty, tz, c1;
    float bx, by, bz, c2;
    float c3, c4, c5, c6;
    float c7, c8, c9, unused;
  };
  struct PackedPlane {
    float cx, cy, cz, inverseSquare;
    float nx, ny, nz, c0;
  };
  struct Branch {
    Vec3f low, high;           ///< box of the balls below
    std::uint32_t begin, end;  ///< nodes below
    std::uint32_t right;       ///< second child; the first one follows; 0: a leaf
  };

  void buildCells();
  std::uint32_t buildTree(std::uint32_t begin, std::uint32_t end);
  void buildDistances(ThreadPool& pool);
  template <int Degree>
  Value evaluateDegree(const Vec3f& p) const;

  std::vector<SlimNode> nodes_;
  int degree_;
  bool closed_;
  Bounds bounds_;
  float largestRadius_ = 0;
  float inverseCell_ = 1;
  CellHash cells_;
  std::vector<std::uint32_t> cellNodes_;
  std::vector<PackedPlane> planes_;
  std::vector<Packed> packed_;
  std::vector<Branch> tree_;
  std::unique_ptr<DistanceGrid> distances_;
};

template <class Visit>
void SlimModel::visitWithin(const Vec3f& p, float reach, const Visit& visit) const {
  std::uint32_t stack[64];
  int depth = 0;
  if (!tree_.empty()) stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t at = stack[--depth];
    const Branch& branch = tree_[at];
    const Vec3f nearest = p.cwiseMax(branch.low).cwiseMin(branch.high);
    if ((nearest - p).squaredNorm() >= reach * reach) continue;
    if (branch.right != 0) {
      stack[depth++] = branch.right;
      stack[depth++] = at + 1;
      continue;
    }
    for (std::uint32_t k = branch.begin; k < branch.end; ++k) {
      const float sum = reach + nodes_[k].radius;
      if ((nodes_[k].centre - p).squaredNorm() < sum * sum) visit(k);
    }
  }
}

// Directions in groups of four that lie close together, each with the cone that holds them: a small ball is
// seen by few groups.

/// Unit vectors, coordinate by coordinate.
struct DirectionSet {
  std::span<const float> x, y, z;
  std::size_t size() const { return x.size(); }
};

/// Four floats, a vector of the compiler's: every x86-64 has it.
using FourFloats = float __attribute__((vector_size(16)));

class DirectionBins {
 public:
  static constexpr std::size_t kLanes = 4;

  /// Whether these are the bins of exactly these directions.
  bool matches(const DirectionSet& directions) const;
  void build(const DirectionSet& directions);

  struct Bin {
    FourFloats x, y, z;
    std::uint32_t index[kLanes];  ///< of the directions; kNone where there is none
  };
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::span<const Bin> bins() const { return bins_; }
  /// Calls visit(bin) for every bin that may hold a direction within the angle from `axis` whose cosine and
  /// sine are given.
  template <class Visit>
  void visitCone(const Vec3f& axis, float cosine, float sine, const Visit& visit) const;

 private:
  void split(std::span<std::uint32_t> order);

  std::vector<float> known_;  ///< x, y, z of the directions
  std::vector<Bin> bins_;
  /// Cones of the bins, four at a time.
  std::vector<FourFloats> axisX_, axisY_, axisZ_, cosine_, sine_;
};

template <class Visit>
void DirectionBins::visitCone(const Vec3f& axis, float cosine, float sine, const Visit& visit) const {
  const float ax = axis.x(), ay = axis.y(), az = axis.z();
  for (std::size_t group = 0; group < axisX_.size(); ++group) {
    const FourFloats towards = ax * axisX_[group] + ay * axisY_[group] + az * axisZ_[group];
    // cos(a + b); half-angles of bins are small, those of cones at most a right angle.
    const FourFloats least = cosine * cosine_[group] - sine * sine_[group];
    const auto seen = towards >= least;
    std::uint64_t halves[2];
    std::memcpy(halves, &seen, sizeof halves);
    if ((halves[0] | halves[1]) == 0) continue;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      if (seen[lane] != 0 && group * kLanes + lane < bins_.size()) visit(bins_[group * kLanes + lane]);
  }
}

// Where rays from one point pass a SLIM surface: the hits with every ball's own polynomial inside a part of
// the ball, those of one passage blended by the balls' weights ([OBA] section 4). The balls in reach are
// gathered once for all rays of the point.

/// Distances (m) at which a ray passes the surface, in order; infinite where there are fewer.
using SlimPassages = std::array<float, 3>;

/// out[k] becomes the passages of direction k within `reach` (m) of `origin`, which is `inside` the surface
/// or outside: the first one changes the side, the second one changes it back. Thread-safe.
void slimPassages(const SlimModel& model, const Vec3f& origin, bool inside, const DirectionSet& directions,
                  float reach, std::span<SlimPassages> out);

/// The first passage of the way from `from` to `to` out of (`leaving`) or into the solid, as a part of the
/// way in [0, 1], and the surface's outward unit normal there. False where there is none.
bool slimFirstPassage(const SlimModel& model, const Vec3f& from, const Vec3f& to, bool leaving, float& at,
                      Vec3f& normal);

/// The least way through the solid (m), inwards from the nodes' centres; infinite for an open surface.
float slimThickness(const SlimModel& model);

// Signed distances to a surface on a coarse grid over its surroundings: cheap far from the surface, and a
// first guess near it. Points far inside a closed surface are known by the sign.

class DistanceGrid {
 public:
  struct Sample {
    float distance;  ///< (m)
    Vec3f gradient;  ///< of the interpolated distance; about 1 long away from the medial axis
  };

  /// `points` lie on the surface less than half of `cell` (m) apart.
  DistanceGrid(const std::vector<OrientedPoint>& points, bool closed, float cell);

  Sample at(const Vec3f& p) const;
  float cell() const { return cell_; }

  /// The edge of a cell (m) for a surface of this extent whose details have this size (m): fine enough for
  /// them if memory allows.
  static float cellFor(const Bounds& bounds, float detail);

 private:
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(x);
  }
  Vec3f vertex(int x, int y, int z) const {
    return origin_ + cell_ * Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  }
  void spread(const std::vector<OrientedPoint>& points, std::vector<std::int32_t>& nearest) const;
  void agreeOnSigns(const std::vector<std::uint8_t>& band);

  float cell_, inverseCell_;
  Vec3f origin_;
  Eigen::Vector3i size_;
  std::vector<float> distances_;
};

}  // namespace migiwa
