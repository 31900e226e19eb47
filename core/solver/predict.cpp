#include "core/solver/stages.h"

namespace migiwa::stages {

void predict(StepState& state) {
  Particles& particles = state.particles;
  resizeTight(state.current, particles.size() + 1);
  const float dt = state.timeStep;
  const Vec3f gain = dt * state.gravity;
  parallelFor(state.pool, particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f velocity = particles.velocity[i].xyz() + gain;
      particles.velocity[i].setXyz(velocity);
      state.current[i] = Float4(Vec3f(particles.position[i].xyz() + dt * velocity));
    }
  });
  // Here rather than after the solve: the density must be that of where particles can be.
  projectAll(state);
}

}  // namespace migiwa::stages
