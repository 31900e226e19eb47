// The stages of a step, in the order in which they run. Each gathers: it writes only what belongs to its own
// particle.
#pragma once

#include "core/solver/step_state.h"

namespace migiwa::stages {

/// v += g dt, then x* = x + v dt, kept on the fluid side of the walls.
void predict(StepState& state);
/// Moves apart what lies on heaps of many particles, see spread_heaps.cpp; the grid is that of the predicted
/// positions, and is made anew.
void spreadHeaps(StepState& state);
/// Sorts the particles along the grid and lists the neighbours of the predicted positions.
void searchNeighbours(StepState& state);
/// gamma and its gradient ([FM] Eq. 6) for the particles near walls.
void evaluateGamma(StepState& state);
/// gamma at the moved positions: linearised, or evaluated anew where a particle has moved too far.
void refreshGamma(StepState& state);
/// Density ([FM] Eq. 5), constraint (Eq. 9) and lambda (Eqs. 11 to 13). Returns the density error.
IterationError computeLambda(StepState& state);
/// Moves the predicted positions by [FM] Eq. 10 in the form that the parameters name, `weight` times as far
/// from the positions of the previous iteration (1: Eq. 10 itself).
void movePositions(StepState& state, float weight = 1);
/// Puts the particles near walls back on the fluid side.
void projectNearWalls(StepState& state);
/// The same for every particle: one that was far from the walls may have crossed one in a single move.
void projectAll(StepState& state);
/// v = (x* - x) / dt, x = x*. What was before is kept in state.before if `keep`.
void updateVelocities(StepState& state, bool keep);
/// Takes over the solved positions and leaves the velocities alone.
void acceptPositions(StepState& state);

}  // namespace migiwa::stages
