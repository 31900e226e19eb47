#include "core/solver/hold_energy.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace migiwa {

namespace {

/// Energy over the share r of the solve's changes that is taken back: E(r) = E(0) - r slope + r^2 bend.
struct Parabola {
  double slope = 0, bend = 0;
};

/// What the solve made of a particle's velocity, before effects on velocities (m/s).
Vec3f solvedVelocity(const StepState& state, std::size_t i) {
  return (state.particles.position[i].xyz() - state.before.position[i].xyz()) / state.timeStep;
}

}  // namespace

double holdEnergy(StepState& state, EffectPipeline& effects, double excess) {
  const std::size_t n = state.particles.size();
  const Vec3f halfGain = 0.5F * state.timeStep * state.gravity;
  Parabola energy = parallelReduce(
      state.pool, n, Parabola{},
      [&](std::size_t begin, std::size_t end) {
        Parabola part;
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3f solved = solvedVelocity(state, i);
          const Vec3d change = Vec3f(solved - state.before.velocity[i].xyz()).cast<double>();
          part.slope += change.dot(Vec3f(solved + halfGain).cast<double>());
          part.bend += 0.5 * change.squaredNorm();
        }
        return part;
      },
      [](const Parabola& a, const Parabola& b) {
        return Parabola{a.slope + b.slope, a.bend + b.bend};
      });
  energy.slope -= state.wallWork.sum() / static_cast<double>(state.timeStep);
  if (excess <= 0 || energy.slope <= 0 || energy.bend <= 0) return 1;

  // The smaller root of r slope - r^2 bend = excess, or the top of the parabola where that is lower.
  const double under = energy.slope * energy.slope - 4 * energy.bend * excess;
  const double back = std::min(
      1.0, under > 0 ? 2 * excess / (energy.slope + std::sqrt(under)) : energy.slope / (2 * energy.bend));
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f predicted = state.before.velocity[i].xyz();
      const Vec3f change = solvedVelocity(state, i) - predicted;
      state.particles.velocity[i].setXyz(predicted + static_cast<float>(1 - back) * change);
    }
  });
  state.wallWork.scale(1 - back);
  state.effectWork -= std::exchange(state.velocityEffectWork, 0);
  effects.changeVelocities(state, {});
  return 1 - back;
}

}  // namespace migiwa
