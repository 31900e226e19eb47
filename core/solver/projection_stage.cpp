#include "core/solver/stages.h"
#include "core/solver/thin_walls.h"

namespace migiwa::stages {

namespace {

/// Puts a particle that came from `from`, where it was at the start of the step or since, back on the fluid
/// side.
void project(const StepState& state, const Float4& from, bool stepBegan, Float4& position) {
  Vec3f p = position.xyz();
  if (!state.barringWalls.empty())
    p = heldBack(state.barringWalls, from.xyz(), stepBegan, p, state.wallMargin());
  state.boundary.project(p, state.wallMargin());
  position.setXyz(p);
}

}  // namespace

void projectNearWalls(StepState& state) {
  parallelFor(state.pool, state.wallSlots.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = state.wallSlots[k].particle;
      project(state, state.previous[i], false, state.current[i]);
    }
  });
}

void projectAll(StepState& state) {
  if (state.boundary.empty()) return;
  parallelFor(state.pool, state.particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      project(state, state.particles.position[i], true, state.current[i]);
  });
}

}  // namespace migiwa::stages
