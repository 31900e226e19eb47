#include "core/solver/clearance.h"
#include "core/solver/stages.h"
#include "core/solver/thin_walls.h"

namespace migiwa::stages {

namespace {

/// What lies right at the margin a shape may still move by the last bit: so much more is certainly enough.
constexpr float kAmple = 1.001F;

/// Puts particle i, which came from `from`, where it was at the start of the step or since, back on the fluid
/// side. Returns how far times the velocity of the wall there (m^2/s), 0 where no wall moves.
double project(StepState& state, std::size_t i, const Float4& from, bool stepBegan) {
  Vec3f p = state.current[i].xyz();
  // How far it may have to be from walls for them not to be in its way.
  const float onTheWay = state.barringWalls.empty() ? 0 : kSteepestDistance * (p - from.xyz()).norm();
  if (knownClearance(state, i, p) >= kAmple * state.wallMargin() + onTheWay) return 0;
  if (!p.allFinite()) return 0;  // no wall has a place for it; the step is about to be refused
  const Vec3f came = p;
  if (!state.barringWalls.empty())
    p = heldBack(state.barringWalls, from.xyz(), stepBegan, p, state.wallMargin());
  state.boundary.project(p, state.wallMargin());
  state.current[i].setXyz(p);
  if (!state.boundary.moves() || p == came) return 0;
  return static_cast<double>(state.boundary.wallVelocity(p).dot(p - came));
}

/// Calls one(k) for all k < count, and books the walls' work that it returns.
template <class One>
void projectEach(StepState& state, std::size_t count, const One& one) {
  state.wallWork.add(parallelReduce(
      state.pool, count, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double work = 0;
        for (std::size_t k = begin; k < end; ++k) work += one(k);
        return work;
      },
      [](double a, double b) { return a + b; }));
}

}  // namespace

void projectNearWalls(StepState& state) {
  projectEach(state, state.wallSlots.size(), [&](std::size_t k) {
    const std::uint32_t i = state.wallSlots[k].particle;
    return project(state, i, state.previous[i], false);
  });
}

void projectAll(StepState& state) {
  if (state.boundary.empty()) return;
  state.wallSlot.resize(state.particles.size(), StepState::kNoWall);
  projectEach(state, state.particles.size(),
              [&](std::size_t i) { return project(state, i, state.particles.position[i], true); });
}

}  // namespace migiwa::stages
