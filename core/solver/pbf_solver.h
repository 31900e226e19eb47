// The position based fluid step ([FM] section 4, Macklin & Mueller 2013) as an ordered list of named, timed
// stages.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/solver/effect_pipeline.h"
#include "core/solver/squeeze.h"
#include "core/solver/step_state.h"

namespace migiwa {

/// Why a step was refused, if it was.
struct StepRefusal {
  bool notFinite = false;  ///< a particle would end at a place or with a velocity that is not finite
  Squeeze squeeze;         ///< walls leave the fluid no room
  bool any() const { return notFinite || squeeze.found; }
};

/// Advances the state by `state.timeStep`, with what the effects add. Positions and velocities of a refused
/// step are those of before (velocities but for rounding, gravity's gain having been added and taken back),
/// in another order.
StepRefusal advanceStep(StepState& state, EffectPipeline& effects);

/// What of a refused step was not finite first.
struct StepFault {
  std::string stage;                      ///< the one that left it so, or the effect
  std::uint32_t particle = 0;             ///< id of one of them
  long particles = 0;                     ///< how many there are
  std::vector<std::uint32_t> neighbours;  ///< ids of that particle's
};
/// Makes a refused step once more and looks through the state after every stage.
StepFault findFault(StepState& state, EffectPipeline& effects);

/// For fluid that starts inside walls: projects it out and solves the density on the positions alone, so that
/// the push does not become speed. Returns how many particles were inside; 0: nothing was done.
long stabilise(StepState& state);

/// Solves the density on the positions alone, for fluid that starts on top of fluid: what pushes particles
/// apart does not become speed.
void relax(StepState& state);

/// Neighbours, gamma, density and lambda of the positions as they are, for a picture of the start.
void prepareFields(StepState& state);

}  // namespace migiwa
