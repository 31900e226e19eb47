// The product over planes for many points at once, with the vector instructions of the processor at hand.
#pragma once

#include <span>

#include "core/boundary/gamma/flat_planes.h"
#include "core/boundary/gamma_method.h"

namespace migiwa {

/// gamma as the product over the planes' axes. Distances are those to the planes: behind two of them they are
/// too short.
void productOfPlanes(const FlatPlanes& walls, KernelType kernel, float supportRadius,
                     std::span<const Float4> points, std::span<GammaSample> out);

}  // namespace migiwa
