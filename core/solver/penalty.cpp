// Penalty walls, that the introduction of [FM] names as the most common ones (Mueller et al. 2004, Monaghan
// 2005): a force by how far a particle has sunk into the solid. Here a spring and a damper push it out,
//
//   a = max(k d + c u, 0) n
//
// d being how much nearer to the wall than at rest, half a spacing, its centre is, u the speed at which it
// goes in, relative to the wall. [FM] has no formula: k and c are our own. The spring carries 40 layers at
// a quarter of a spacing; the damper is half of the critical one. Both are taken at the end of the step
// (implicit Euler), so that no stiffness limits the step. A tenth of a spacing in front of the wall particles
// are kept out as by all walls, so that none is lost.
#include <algorithm>
#include <cmath>

#include "core/solver/state.h"
#include "core/solver/step.h"

namespace migiwa::stages {

void pushOutOfSoftWalls(StepState& state) {
  constexpr float kLayers = 40, kSunk = 0.25F, kLeastGravity = 9.81F;
  const float stiffness = std::max(state.gravity.norm(), kLeastGravity) * kLayers / (kSunk * state.spacing);
  const float damping = std::sqrt(stiffness), dt = state.timeStep;
  const float share = 1 / (1 + dt * damping + dt * dt * stiffness);
  state.wallSlot.resize(state.particles.size(), FluidState::kNoWall);
  state.effectWork -= predictedEnergy(state);
  parallelEach(state.pool, state.particles.size(), [&](std::size_t i) {
    const Vec3f at = state.particles.position[i].xyz();
    if (!at.allFinite() || knownFarther(state, i, at, state.restingMargin())) return;
    Vec3f normal;
    const float depth = state.restingMargin() - state.boundary.distance(at, normal);
    if (depth <= 0) return;
    const Vec3f velocity = state.particles.velocity[i].xyz() - state.boundary.wallVelocity(at);
    const float inwards = -velocity.dot(normal);
    const float stopped = inwards - share * (inwards - dt * stiffness * depth);
    if (stopped > 0) state.current[i].setXyz(state.current[i].xyz() + dt * stopped * normal);
  });
  state.effectWork += predictedEnergy(state);
}

}  // namespace migiwa::stages
