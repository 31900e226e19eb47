// How far from incompressible the fluid is after an iteration: what [FM] section 4 iterates on.
#pragma once

namespace migiwa {

/// Density error max(rho/rho0 - 1, 0) over the particles, after an iteration.
struct IterationError {
  double mean = 0;
  double max = 0;
  double meanSquare = 0;  ///< mean of the squares
};

}  // namespace migiwa
