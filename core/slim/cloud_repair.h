// Makes points with normals as files hold them into points whose normals agree.
#pragma once

#include <string>
#include <vector>

#include "core/slim/oriented_points.h"

namespace migiwa {

/// Drops points that are there twice, estimates normals where all are zero, turns those against most of their
/// neighbours, and all of them if they point inwards. Adds a sentence to `notes` for each kind of repair.
/// Returns whether the points seem to cover a closed surface, on which normals cancel. Throws InputError at
/// `place` for fewer than 50 points.
bool repairCloud(std::vector<OrientedPoint>& points, const std::string& place,
                 std::vector<std::string>& notes);

}  // namespace migiwa
