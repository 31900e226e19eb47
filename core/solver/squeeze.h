// Fluid that walls leave less room than it needs: no place of the particles is free of density errors, and a
// solve that is given time would turn the errors that it cannot undo into ever more speed.
#pragma once

#include "core/solver/step_state.h"

namespace migiwa {

/// Density error of a start, or of what a step leaves, above which fluid is on top of fluid. A lattice
/// between walls reads some percent.
inline constexpr double kCrowded = 0.5;

/// Mean density error that fluid with room enough is never left with. Uniform fluid has it when its room is a
/// tenth too small; what a lattice between walls reads by itself is half of that in the layers at the walls,
/// and less in the mean.
inline constexpr double kSqueezed = 0.1;

/// What is left of the density errors once nothing is asked of the fluid but room.
struct Squeeze {
  bool found = false;
  double mean = 0;              ///< density error
  double largest = 0;           ///< density error
  Vec3f place = Vec3f::Zero();  ///< where it is (m)
};

/// Whether the places where a step ends, `state.current`, leave density errors for want of room: those above
/// a bound that stay above it when the density is solved on positions alone, at length and with no speed or
/// gravity to work against. Looks at `state.errors` alone where these are within the bounds.
Squeeze findSqueeze(const StepState& state);

}  // namespace migiwa
