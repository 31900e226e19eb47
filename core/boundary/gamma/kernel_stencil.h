// A kernel as weights on a lattice, for integrals over whatever part of it is fluid (fluid_lattice.h): the
// trilinear function through the weights is the best approximation of W in the mean square, so its integrals
// against everything trilinear are exact.
#pragma once

#include <array>

#include "core/boundary/gamma/fluid_lattice.h"
#include "core/sph/kernel_type.h"

namespace migiwa {

struct KernelStencil {
  /// Points of the lattice along a support radius.
  static constexpr int kPerSupport = 10;
  static constexpr int kReach = FluidLattice::kReach, kSide = 2 * kReach + 1, kStride = kSide + 1;

  /// Sum 1; x fastest, rows of kStride with a zero at the end.
  std::array<float, std::size_t{kSide} * kSide * kStride> weights;
};

KernelStencil kernelStencil(KernelType kernelType);

}  // namespace migiwa
