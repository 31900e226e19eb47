// The solvers: how the fluid is kept from being compressed. A solver is a file, and a line here.
#pragma once

#include <array>

#include "core/solver/parameters.h"

namespace migiwa {

struct StepState;

/// A solver other than PBF from positions: what a step does between `gamma` and the move. The stages before
/// and after it are those of all.
struct Solver {
  /// Puts pressures into state.projectedPressure and what they do into the particles' velocities, at the
  /// places state.current, whose neighbours and gamma are known. All but PBF leave density, lambda and
  /// density errors, too, of which PBF's constraint makes its own.
  void (*press)(StepState&);
  /// The longest step (s) over which it is stable; null: any that the CFL rule allows.
  double (*longestStep)(const StepState&);
};

namespace stages {
void projectVelocities(StepState& state);      ///< see projection_simd.cpp
void pressByDensity(StepState& state);         ///< see wcsph.cpp
void pressByPrediction(StepState& state);      ///< see pcisph.cpp
void pressFreeOfDivergence(StepState& state);  ///< see dfsph.cpp
}  // namespace stages
double soundStep(const StepState& state);

/// In the order of SolverMethod.
inline constexpr std::array kSolvers{
    Solver{stages::projectVelocities, nullptr},  // pbf, with "velocity_step": "projection"
    Solver{stages::pressByDensity, soundStep},
    Solver{stages::pressByPrediction, nullptr},
    Solver{stages::pressFreeOfDivergence, nullptr},
};
static_assert(kSolvers.size() == kSolverMethodNames.size());

}  // namespace migiwa
