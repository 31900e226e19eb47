// Tables of points as CSV: a header that names the columns, then a row a point.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/math.h"

namespace migiwa {

/// Reads the columns x, y and z (unit: m), in any order and among others. Throws InputError with every fault,
/// each as `FILE:LINE: expected ..., found ...`.
std::vector<Vec3d> readPoints(const std::filesystem::path& file);

}  // namespace migiwa
