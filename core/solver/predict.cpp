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
      Vec3f predicted = particles.position[i].xyz() + dt * velocity;
      // Projection here rather than after the solve: the density must be that of where particles can be.
      state.boundary.project(predicted, state.wallMargin());
      state.current[i] = Float4(predicted);
    }
  });
}

}  // namespace migiwa::stages
