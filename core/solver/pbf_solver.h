// The position based fluid step ([FM] section 4, Macklin & Mueller 2013) as an ordered list of named, timed
// stages.
#pragma once

#include "core/solver/effect_pipeline.h"
#include "core/solver/step_state.h"

namespace migiwa {

/// Advances the state by `state.timeStep`, with what the effects add.
void advanceStep(StepState& state, EffectPipeline& effects);

/// For fluid that starts inside walls: projects it out and solves the density on the positions alone, so that
/// the push does not become speed. Returns how many particles were inside; 0: nothing was done.
long stabilise(StepState& state);

/// Solves the density on the positions alone, for fluid that starts on top of fluid: what pushes particles
/// apart does not become speed.
void relax(StepState& state);

/// Neighbours, gamma, density and lambda of the positions as they are, for a picture of the start.
void prepareFields(StepState& state);

}  // namespace migiwa
