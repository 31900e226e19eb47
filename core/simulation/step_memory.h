// What of the solver's state lasts from step to step, visited for a save.
#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/state_visitor.h"
#include "core/solver/step_state.h"

namespace migiwa {

/// Particles in their order, the points at which gamma was last evaluated, and the fields of the last step
/// that pictures show. `neighbours`: counts of the last step. Reading throws StateError, before it changes
/// anything, when what was saved contradicts itself.
void visitStepMemory(StateVisitor& visitor, StepState& state, std::vector<std::uint32_t>& neighbours);

}  // namespace migiwa
