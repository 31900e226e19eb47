// Energy that a step made from nothing. A projection onto a convex set that holds the start never lengthens
// the way, so that undoing density errors takes kinetic energy. The density is not convex in the positions,
// and particles that hit each other at half a spacing a step are pushed out of one another by the sum of what
// each neighbour alone would ask for: further than they came, and by the next step with that speed.
//
// Pushes act between neighbours, so the particles that are connected by neighbours are a group of its own:
// what a group gained is taken from that group. Within it a pair has gained whose members part faster than
// they came, and where it lies among others that gained, it gives back of what the solve changed of its
// relative velocity as much as is too much. One takes what the other gives: momentum stays, of all and of
// each group. Walls that push a particle off faster than it came take back their own push, along their
// normal.
#pragma once

#include <cstddef>

#include "core/solver/effect_pipeline.h"
#include "core/solver/step_state.h"

namespace migiwa {

/// What holdEnergy() has done.
struct HeldEnergy {
  double taken = 0;           ///< (m^2/s^2), a sum over the particles
  std::size_t particles = 0;  ///< whose velocity it has changed
};

/// Takes `excess` (m^2/s^2, a sum over the particles) of a finished step's energy back, or as much of it as
/// there is, where it was gained. Only velocities change; positions stay, and so what the solve has undone of
/// density errors. What moving walls gave less by it is taken off their work, and effects on velocities act
/// anew. The neighbours are those that the step was solved with.
HeldEnergy holdEnergy(StepState& state, EffectPipeline& effects, double excess);

}  // namespace migiwa
