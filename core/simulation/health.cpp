#include "core/simulation/health.h"

#include <algorithm>
#include <cmath>

namespace migiwa {

HealthLimits healthLimits(const Scene& scene) {
  HealthLimits limits;
  limits.mostPenetration = scene.particleSpacing;
  if (const Bounds bounds = scene.bounds(); !bounds.empty()) {
    limits.centre = bounds.center().cast<float>();
    limits.farthest = bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).norm();
  }
  // Far enough for any splash to come back, near enough that what fell through a hole is found.
  if (!scene.surfaces.empty()) {
    const Bounds bounds = scene.bounds();
    if (!bounds.empty()) limits.scene = bounds.grown(10 * bounds.size().norm());
  }
  return limits;
}

Health inspect(const StepState& state, const HealthLimits& limits) {
  const Particles& particles = state.particles;
  return parallelReduce(
      state.pool, particles.size(), Health{},
      [&](std::size_t begin, std::size_t end) {
        Health part;
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3f position = particles.position[i].xyz(), velocity = particles.velocity[i].xyz();
          if (!position.allFinite() || !velocity.allFinite()) {
            ++part.nonfinite;
            part.firstBad = particles.id[i];
            continue;
          }
          part.maxSpeed = std::max(part.maxSpeed, velocity.norm());
          part.energy.add(position, velocity, limits.centre);
          const bool clear = particles.position[i].w > 0;
          const float penetration = clear ? 0 : -state.boundary.distance(position);
          part.maxPenetration = std::max(part.maxPenetration, penetration);
          const bool out = !limits.scene.empty() && !limits.scene.contains(position.cast<double>());
          if (out || static_cast<double>(penetration) > limits.mostPenetration) {
            ++part.lost;
            part.firstBad = particles.id[i];
          }
        }
        return part;
      },
      [](Health a, const Health& b) {
        if (a.lost + a.nonfinite == 0) a.firstBad = b.firstBad;
        a.maxSpeed = std::max(a.maxSpeed, b.maxSpeed);
        a.maxPenetration = std::max(a.maxPenetration, b.maxPenetration);
        a.energy += b.energy;
        a.lost += b.lost;
        a.nonfinite += b.nonfinite;
        return a;
      });
}

}  // namespace migiwa
