#include "core/solver/clearance.h"
#include "core/solver/stages.h"

namespace migiwa::stages {

void updateVelocities(StepState& state) {
  Particles& particles = state.particles;
  const float inverseStep = 1 / state.timeStep;
  parallelFor(state.pool, particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f solved = state.current[i].xyz();
      const float clearance = knownClearance(state, i, solved);
      particles.velocity[i] = Float4((solved - particles.position[i].xyz()) * inverseStep);
      particles.position[i] = Float4(solved, clearance);
    }
  });
}

void acceptPositions(StepState& state) {
  Particles& particles = state.particles;
  for (std::size_t i = 0; i < particles.size(); ++i) particles.position[i] = Float4(state.current[i].xyz());
}

}  // namespace migiwa::stages
