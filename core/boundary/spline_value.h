// Value and gradient of a tricubic B-spline of one channel, from the coefficients about its cell.
#pragma once

#include "core/boundary/spline_grid.h"

namespace migiwa {

struct SplineValue {
  float value;
  Vec3f gradient;  ///< per cell
};

/// `first`: the first of the 4 x 4 x 4 coefficients about the cell, in a block of a SplineGrid<1>. x, y and
/// z: the place in the cell, in [0, 1).
SplineValue splineValue(const float* first, float x, float y, float z);

}  // namespace migiwa
