// Normals for points that have none, or none that agree: planes through neighbours, whose sides are made to
// agree along the spanning tree that turns least (Hoppe, DeRose, Duchamp, McDonald and Stuetzle 1992, Surface
// reconstruction from unorganized points), and then to face outwards.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/slim/oriented_points.h"

namespace migiwa {

/// Gives every point the normal of the plane of best fit through its neighbours, out of the solid that the
/// points cover all around. There must be at least 50 points, no two at the same place. Throws InputError at
/// `place` where inside and outside cannot be told apart: on an open surface, or where two sheets are too
/// close for the points' distance. Sorts the points anew, the same way every time.
void estimateNormals(std::vector<OrientedPoint>& points, const std::string& place);

/// Turns normals so that they agree and face outwards. Returns how many were turned; none where they agree
/// already, and none where it cannot be decided.
std::size_t orientNormals(std::vector<OrientedPoint>& points);

}  // namespace migiwa
