// A SLIM surface ([OBA]): nodes, and a search among them whose cost does not depend on their number. Positive
// distances are on the side that the nodes' normals point to: outside the solid.
#pragma once

#include <memory>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/parallel.h"
#include "core/slim/cell_hash.h"
#include "core/slim/slim_node.h"

namespace migiwa {

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

}  // namespace migiwa
