// What a step's end looks like: finite or not, how fast, how far past the walls.
#pragma once

#include "core/base/bounds.h"
#include "core/scene/scene.h"
#include "core/solver/step_state.h"

namespace migiwa {

struct HealthLimits {
  double mostPenetration = 0;    ///< past a wall by more than this (m) is lost: one spacing
  Bounds scene;                  ///< out of this is lost; empty for a scene without walls
  double farthest = 0;           ///< coordinate of the scene (m), whose rounding velocities bear
  Vec3f centre = Vec3f::Zero();  ///< of the scene at its start: where potential energy is zero (m)
};
HealthLimits healthLimits(const Scene& scene);

struct Health {
  float maxSpeed = 0;        ///< (m/s)
  float maxPenetration = 0;  ///< (m)
  long lost = 0;
  long nonfinite = 0;
  EnergySums energy;           ///< of the finite particles
  std::uint32_t firstBad = 0;  ///< id of a lost or non-finite particle, if there is one
};
Health inspect(const StepState& state, const HealthLimits& limits);

}  // namespace migiwa
