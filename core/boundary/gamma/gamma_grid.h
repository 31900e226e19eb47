// gamma on a sparse grid about the walls. The gradients are those of the splines, so they belong to the gamma
// that is returned.
#pragma once

#include <span>

#include "core/boundary/gamma_method.h"
#include "core/boundary/spline_grid.h"

namespace migiwa {

/// Channels: gamma for the density kernel, and for the kernel of the pair gradients.
using GammaGrid = SplineGrid<2>;

/// Interpolates at places in blocks with coefficients: gamma and gradients, not the distance. Samples of
/// other places are left alone.
void interpolate(const GammaGrid& grid, float supportRadius, std::span<const GammaGrid::Place> places,
                 std::span<GammaSample> out);

}  // namespace migiwa
