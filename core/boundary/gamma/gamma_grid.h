// gamma on a sparse grid about the walls. The gradients are those of the splines, so they belong to the gamma
// that is returned.
#pragma once

#include <span>

#include "core/boundary/gamma_method.h"
#include "core/boundary/spline_grid.h"

namespace migiwa {

/// Channels: gamma for the density kernel, and for the kernel of the pair gradients.
using GammaGrid = SplineGrid<2>;

/// Interpolates at points that lie in blocks with coefficients: gamma and gradients, not the distance.
/// blocks[i] is blockAt(points[i]); points in other blocks are left alone.
void interpolate(const GammaGrid& grid, float supportRadius, std::span<const Float4> points,
                 std::span<const std::int32_t> blocks, std::span<GammaSample> out);

}  // namespace migiwa
