// What the kernels sum to on the cubic lattice that a scene starts from. The rest density is that sum, so
// that a resting lattice has C = 0, and Eq. 11's epsilon is measured in units of its constraint gradients.
#pragma once

#include "core/sph/kernel_type.h"

namespace migiwa {

struct RestingLattice {
  /// m / (rho0 h^3): what one particle adds to rho/rho0 is this times W(q).
  float massRatio;
  /// Sum over the neighbours of |h grad_k C|^2 at rest (1).
  float squaredGradients;
};

/// `supportRatio`: support radius over spacing, in [1.2, 4].
RestingLattice restingLattice(KernelType kernel, double supportRatio);

}  // namespace migiwa
