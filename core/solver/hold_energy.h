// Energy that a step made from nothing. A projection onto a convex set that holds the start never lengthens
// the way, so that undoing density errors takes kinetic energy. The density is not convex in the positions,
// and particles that hit each other at half a spacing a step are pushed out of one another by the sum of what
// each neighbour alone would ask for: further than they came, and by the next step with that speed.
#pragma once

#include "core/solver/effect_pipeline.h"
#include "core/solver/step_state.h"

namespace migiwa {

/// Takes `excess` (m^2/s^2, a sum over the particles) of a finished step's energy back, or as much of it as
/// there is: all that the solve changed of velocities is scaled by one factor between 0 and 1. Pushes between
/// particles stay equal and opposite, so no momentum is made; positions stay, and so what the solve has
/// undone of density errors. The walls' work is scaled along, and effects on velocities act anew. Returns the
/// factor, 1 where there is nothing to take.
double holdEnergy(StepState& state, EffectPipeline& effects, double excess);

}  // namespace migiwa
