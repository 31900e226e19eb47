// Whether a scene's particles have room on this machine.
#pragma once

#include <optional>
#include <string>

#include "core/scene/scene.h"

namespace migiwa {

/// Memory that a particle takes while it is simulated, all arrays and neighbour lists together (bytes).
inline constexpr double kBytesPerParticle = 600;

/// Particles of all fluid sources, and of all emitters within the duration, at most.
double particleCount(const Scene& scene);

/// "expected ..., found ..." with the spacing that would do, or nothing when `particles` fit into `memory`
/// (bytes).
std::optional<std::string> tooManyParticles(double particles, double spacing, double memory);

}  // namespace migiwa
