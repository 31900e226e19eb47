// What the kernels sum to on the cubic lattice that a scene starts from. The rest density is that sum, so
// that a resting lattice has C = 0, and Eq. 11's epsilon is measured in units of its constraint gradients.
#pragma once

#include <cmath>

#include "core/sph/kernel_type.h"

namespace migiwa {

struct RestingLattice {
  /// m / (rho0 h^3): what one particle adds to rho/rho0 is this times W(q).
  float massRatio;
  /// Sum over the neighbours of |h grad_k C|^2 at rest (1).
  float squaredGradients;
};

/// Sum of term(q) over the places of the lattice within the support radius of one, itself left out; q is the
/// distance over the support radius.
template <class Term>
double latticeSum(double supportRatio, const Term& term) {
  const int reach = static_cast<int>(std::ceil(supportRatio));
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const int square = i * i + j * j + k * k;
        if (square == 0) continue;
        const double q = std::sqrt(static_cast<double>(square)) / supportRatio;
        if (q < 1) sum += term(q);
      }
    }
  }
  return sum;
}

/// `supportRatio`: support radius over spacing, in [1.2, 4].
RestingLattice restingLattice(KernelType kernel, double supportRatio);

}  // namespace migiwa
