// Where a plane across an axis cuts surfaces: the outline of the cut.
#pragma once

#include <span>
#include <vector>

#include "core/boundary/wall_drawing.h"

namespace migiwa {

/// Segments at `at` (m) on the axis with number `axis`.
std::vector<LineSegment> sectionLines(std::span<const WallMesh> meshes, Eigen::Index axis, float at);

}  // namespace migiwa
