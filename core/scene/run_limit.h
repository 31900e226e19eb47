// Whether a scene can be run to a given time at all: in steps that somebody can wait for, and with particles
// that have room. Both are asked before anything is made, of the time that the run really ends at.
#pragma once

#include <optional>
#include <string>

#include "core/scene/scene.h"

namespace migiwa {

/// Steps that a run has at most. At a microsecond a step, which no machine reaches, they take a quarter of an
/// hour for a handful of particles, and years for a scene that is worth looking at.
inline constexpr double kMostSteps = 1e9;

/// Steps of a run to `time` (s), at least: the CFL rule may ask for more.
double fewestSteps(const SolverParameters& solver, double time);

/// "expected ..., found ..." for a time_step of which `duration` (s) has too many, or nothing.
std::optional<std::string> tooShortStep(const SolverParameters& solver, double duration);

/// "expected ..., found ..." for an end `until` (s) that the scene cannot be run to, or nothing: too many
/// steps, or emitters that by then have given more particles than fit into `memory` (bytes).
std::optional<std::string> tooLateAnEnd(const Scene& scene, double until, double memory);

/// Throws InputError at `option` for such an end and the memory that is available.
void requireReachable(const Scene& scene, double until, const std::string& option);

}  // namespace migiwa
