// Whether a scene's particles have room on this machine.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/scene/scene.h"

namespace migiwa {

/// Memory that a particle takes while it is simulated, all arrays and neighbour lists together (bytes).
inline constexpr double kBytesPerParticle = 600;

/// Particles that a simulation has at most, whatever the memory: neighbours are listed by their offsets in
/// bytes, of 16 a particle, in 32 bits; one place is for the ghost.
inline constexpr double kLargestCount = 268435455;

/// A positive number for people, to two digits up or three down; no other digits than it needs.
double shownRoundedUp(double value);
double shownRoundedDown(double value);

/// Particles that fit into `memory` (bytes).
double mostParticles(double memory);

/// Particles of all fluid sources, and of all emitters until `time` (s), at most, at any spacing (m).
double particleCount(const Scene& scene, double spacing, double time);
/// The same at the scene's spacing within its duration.
double particleCount(const Scene& scene);

/// "expected ..., found ..." with the spacing that would do, or nothing when the particles fit into `memory`
/// (bytes). `count` says how many there are at a spacing (m).
std::optional<std::string> tooManyParticles(const std::function<double(double)>& count, double spacing,
                                            double memory);
/// The same for so many particles that go with the spacing to the power of -3.
std::optional<std::string> tooManyParticles(double particles, double spacing, double memory);

}  // namespace migiwa
