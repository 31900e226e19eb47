// Walls thinner than the support radius, METHOD: gamma counts only the fluid that a particle sees, so what
// lies behind such a wall is no neighbour, and no particle may pass through it in one move.
#pragma once

#include "core/solver/step_state.h"

namespace migiwa {

/// The walls of a boundary that are thinner than the support radius (m).
std::vector<const Surface*> thinWalls(const Boundary& boundary, float supportRadius);
/// Those, solids of which a part is so thin, and the solids that move: they may come from one side of a
/// particle to the other in one step.
std::vector<const Surface*> barringWalls(const Boundary& boundary, float supportRadius);

/// Where a move ends that thin walls bar: `margin` (m) before the wall that it meets, where it would have
/// gone along the wall. A move that starts inside of a wall is left as it is. `from` is a place of the start
/// of the step if `stepBegan`: what counts is the way relative to the wall, which has moved since.
Vec3f heldBack(const std::vector<const Surface*>& walls, const Vec3f& from, bool stepBegan, const Vec3f& to,
               float margin);

namespace stages {

/// Takes those across a thin wall out of the neighbour lists.
void separateNeighbours(StepState& state);

}  // namespace stages

}  // namespace migiwa
