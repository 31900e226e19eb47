// Fits SLIM surfaces to oriented points.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/base/fields.h"
#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/slim/model.h"
#include "core/slim/node.h"
#include "core/slim/points.h"
#include "core/slim/shape_import.h"

namespace migiwa {

// Covers a solid's surface with balls and fits a polynomial in each, top down: every ball is as large as the
// tolerance lets it be, and balls are added until every point lies in the core of one ([OBA] section 3).
//
// Deviation: [OBA] asks for a summed weight of 1.5 at every point. One ball that is deep enough needs
// clearly fewer nodes for the same error, and gives rays a part of each ball that leaves no holes.

struct SlimFitOptions {
  int degree = 2;        ///< of the polynomials (range: 1 to 3)
  double tolerance = 0;  ///< largest distance of a ball's polynomial to its points (unit: m, range: (0,
                         ///< inf)); unless nodes > 0
  int nodes = 0;         ///< how many balls to aim at, within 5 %; 0: as many as the tolerance asks for
  double radius = 0;     ///< of all balls (m), whatever the error; 0: by the tolerance
};

/// Nodes that cover all points. Deterministic for any number of threads. `progress`, if given, is called with
/// the part that is done (0 to 1).
std::vector<SlimNode> fitSlim(const OrientedPoints& points, const SlimFitOptions& options, ThreadPool& pool,
                              const std::function<void(double)>& progress = {});

// Coarser balls over those of a fit, so that one fit serves every tolerance: neighbouring balls are merged,
// the pair whose common polynomial errs least first, down to the few that no polynomial joins ([OBA] section
// 5). Each ball stands for points of its own, which its core contains, and a merged one for those of both: so
// whatever tolerance cuts the tree, every point lies in the core of a ball of the cut, as after a fit.

/// Merged balls, children before parents. The balls of the fit have the numbers from 0 on, merged ones those
/// that follow. `error` of a merged ball is at least that of its children.
struct SlimHierarchy {
  std::vector<SlimNode> merged;
  std::vector<std::array<std::uint32_t, 2>> children;  ///< numbers, of each of `merged`
};

/// Merges `nodes`, which fitSlim has fitted to these points with this degree. Deterministic for any number of
/// threads.
SlimHierarchy mergeSlim(const OrientedPoints& points, const std::vector<SlimNode>& nodes, int degree,
                        ThreadPool& pool);

/// The fewest balls whose errors are within the tolerance (m): those of the fit where none is as coarse.
std::vector<SlimNode> cutSlim(const std::vector<SlimNode>& nodes, const SlimHierarchy& hierarchy,
                              double tolerance);
/// The tolerance (m) that leaves at most `wanted` balls, or all that can be merged merged; 0 where the fit
/// itself has no more.
double toleranceFor(const std::vector<SlimNode>& nodes, const SlimHierarchy& hierarchy, std::size_t wanted);

// A shape into a SLIM surface, with figures on how well the two agree.

/// How far the surface is from what it was fitted to, measured at points of the input that the fit has not
/// seen.
struct SlimStatistics {
  std::string source;      ///< what was fitted, for people
  double largest = 0;      ///< distance (m)
  double mean = 0;         ///< distance (m)
  std::size_t points = 0;  ///< that were looked at
};

/// What a file of ours holds.
struct SlimData {
  std::vector<SlimNode> nodes;  ///< of the fit
  SlimHierarchy hierarchy;      ///< coarser ones; empty: none
  int degree = 1;
  bool closed = true;
  SlimStatistics statistics;
};

/// Tolerance (m) where the user gave neither a tolerance nor a number of nodes: a thousandth of the diagonal.
double defaultSlimTolerance(const Bounds& bounds);

/// Fits a SLIM surface to the shape, and its hierarchy. With neither tolerance nor nodes in `options`, by the
/// default tolerance. Says how far it is, see core/base/progress.h.
SlimData fitShape(const ImportedShape& shape, SlimFitOptions options, ThreadPool& pool);

/// Replaces the nodes by those of the hierarchy that the tolerance (m) allows or, if that is 0, by at most
/// `nodes`; with both 0 they stay. Drops the hierarchy. Returns what is worth saying: nothing, or that the
/// data is not as fine as that.
std::string cutTo(SlimData& data, double tolerance, int nodes);

/// Distances from `points` to the surface.
SlimStatistics measureSlim(const SlimModel& model, const std::vector<OrientedPoint>& points,
                           ThreadPool& pool);
/// From points on the shape: on a mesh some that no fit uses, of a point cloud all.
SlimStatistics measureSlim(const SlimModel& model, const ImportedShape& shape, ThreadPool& pool);

/// In double, as far as the file says: a shape far from the origin can be moved back without loss.
void transformShape(ImportedShape& shape, const Transform& transform);
void transformNodes(std::vector<SlimNode>& nodes, const Transform& transform);

// Small balls around sets of points that are joined again and again.

/// The farthest points of a set in 26 directions. Those of the union of two sets are found among theirs.
class Extremes {
 public:
  void include(const Vec3f& p);
  void include(const Extremes& other);
  /// Near the centre of the smallest ball around the points: that ball about it is some hundredths wider. At
  /// least one point must have been included.
  Vec3f centre() const;

 private:
  static constexpr std::size_t kDirections = 26;
  std::array<Vec3f, kDirections> points_;
  std::array<float, kDirections> reaches_;
  bool any_ = false;
};

// A bowl or glass by formula: all points within half a thickness of the lower half of a sphere and of the
// cylinder that stands on it, so that its rim is rounded. For scenes that need no file, and for tests: its
// distance is known exactly.

struct Bowl {
  Vec3d center = Vec3d::Zero();  ///< of the sphere (m)
  double radius = 1;             ///< of the sphere midway in the wall (m)
  double thickness = 0.2;        ///< of the wall (m), less than the diameter
  double height = 0;             ///< of the rim above the centre (m): 0 is a bowl, more a glass

  bool operator==(const Bowl&) const = default;
};

/// Signed distance of p (m), positive outside the solid, and the unit normal at the nearest point.
double bowlDistance(const Bowl& bowl, const Vec3d& p, Vec3d& normal);

/// About `count` points spread evenly over its surface, with exact positions and normals.
OrientedPoints bowlPoints(const Bowl& bowl, std::size_t count);

}  // namespace migiwa
