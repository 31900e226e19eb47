// A shape into a SLIM surface, with figures on how well the two agree.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/slim/shape_import.h"
#include "core/slim/slim_fit.h"
#include "core/slim/slim_hierarchy.h"
#include "core/slim/slim_model.h"
#include "core/slim/transform.h"

namespace migiwa {

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
/// default tolerance.
SlimData fitShape(const ImportedShape& shape, SlimFitOptions options, ThreadPool& pool,
                  const std::function<void(double)>& progress = {});

/// Replaces the nodes by those of the hierarchy that the tolerance (m) allows or, if that is 0, by at most
/// `nodes`; with both 0 they stay. Drops the hierarchy. Returns what is worth saying: nothing, or that the
/// data is not as fine as that.
std::string cutTo(SlimData& data, double tolerance, int nodes);

/// Distances from `points` to the surface.
SlimStatistics measureSlim(const SlimModel& model, const std::vector<OrientedPoint>& points,
                           ThreadPool& pool);
/// From points on the shape: on a mesh some that no fit sees, of a point cloud all.
SlimStatistics measureSlim(const SlimModel& model, const ImportedShape& shape, ThreadPool& pool);

void transformShape(ImportedShape& shape, const Transform& transform);
void transformNodes(std::vector<SlimNode>& nodes, const Transform& transform);

}  // namespace migiwa
