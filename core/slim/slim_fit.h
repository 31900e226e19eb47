// Covers a solid's surface with balls and fits a polynomial in each, top down: every ball is as large as the
// tolerance lets it be, and balls are added until every point lies in the core of one ([OBA] section 3).
//
// Deviation: [OBA] asks for a summed weight of 1.5 at every point. One ball that is deep enough needs
// clearly fewer nodes for the same error, and gives rays a part of each ball that leaves no holes.
#pragma once

#include <functional>
#include <vector>

#include "core/base/parallel.h"
#include "core/slim/oriented_points.h"
#include "core/slim/slim_node.h"

namespace migiwa {

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

}  // namespace migiwa
