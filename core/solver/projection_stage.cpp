#include "core/solver/stages.h"

namespace migiwa::stages {

namespace {

void project(const StepState& state, Float4& position) {
  Vec3f p = position.xyz();
  if (state.boundary.project(p, state.wallMargin())) position.setXyz(p);
}

}  // namespace

void projectNearWalls(StepState& state) {
  parallelFor(state.pool, state.wallSlots.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) project(state, state.current[state.wallSlots[k].particle]);
  });
}

void projectAll(StepState& state) {
  if (state.boundary.empty()) return;
  parallelFor(state.pool, state.particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) project(state, state.current[i]);
  });
}

}  // namespace migiwa::stages
