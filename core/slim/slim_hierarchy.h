// Coarser balls over those of a fit, so that one fit serves every tolerance: neighbouring balls are merged,
// the pair whose common polynomial errs least first, down to the few that no polynomial joins ([OBA] section
// 5). Each ball stands for points of its own, which its core contains, and a merged one for those of both: so
// whatever tolerance cuts the tree, every point lies in the core of a ball of the cut, as after a fit.
#pragma once

#include <array>
#include <vector>

#include "core/base/parallel.h"
#include "core/slim/oriented_points.h"
#include "core/slim/slim_node.h"

namespace migiwa {

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

}  // namespace migiwa
