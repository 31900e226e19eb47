#include "core/solver/clearance.h"
#include "core/solver/stages.h"

namespace migiwa::stages {

void updateVelocities(StepState& state, bool keep) {
  Particles& particles = state.particles;
  const std::size_t n = particles.size();
  // Written beside instead of over them, which costs no pass of its own.
  std::vector<Float4>& position = keep ? state.before.position : particles.position;
  std::vector<Float4>& velocity = keep ? state.before.velocity : particles.velocity;
  resizeTight(position, n);
  resizeTight(velocity, n);
  const float inverseStep = 1 / state.timeStep;
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f solved = state.current[i].xyz();
      const float clearance = knownClearance(state, i, solved);
      velocity[i] = Float4((solved - particles.position[i].xyz()) * inverseStep);
      position[i] = Float4(solved, clearance);
    }
  });
  if (!keep) return;
  particles.position.swap(state.before.position);
  particles.velocity.swap(state.before.velocity);
}

void acceptPositions(StepState& state) {
  Particles& particles = state.particles;
  for (std::size_t i = 0; i < particles.size(); ++i) particles.position[i] = Float4(state.current[i].xyz());
}

}  // namespace migiwa::stages
