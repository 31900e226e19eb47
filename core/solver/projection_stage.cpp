#include "core/solver/clearance.h"
#include "core/solver/stages.h"
#include "core/solver/thin_walls.h"

namespace migiwa::stages {

namespace {

/// What lies right at the margin a shape may still move by the last bit: so much more is certainly enough.
constexpr float kAmple = 1.001F;

/// Puts particle i, which came from `from`, where it was at the start of the step or since, back on the fluid
/// side.
void project(StepState& state, std::size_t i, const Float4& from, bool stepBegan) {
  Vec3f p = state.current[i].xyz();
  // How far it may have to be from walls for them not to be in its way.
  const float onTheWay = state.barringWalls.empty() ? 0 : kSteepestDistance * (p - from.xyz()).norm();
  if (knownClearance(state, i, p) >= kAmple * state.wallMargin() + onTheWay) return;
  if (!state.barringWalls.empty())
    p = heldBack(state.barringWalls, from.xyz(), stepBegan, p, state.wallMargin());
  state.boundary.project(p, state.wallMargin());
  state.current[i].setXyz(p);
}

}  // namespace

void projectNearWalls(StepState& state) {
  parallelFor(state.pool, state.wallSlots.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = state.wallSlots[k].particle;
      project(state, i, state.previous[i], false);
    }
  });
}

void projectAll(StepState& state) {
  if (state.boundary.empty()) return;
  state.wallSlot.resize(state.particles.size(), StepState::kNoWall);
  parallelFor(state.pool, state.particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) project(state, i, state.particles.position[i], true);
  });
}

}  // namespace migiwa::stages
