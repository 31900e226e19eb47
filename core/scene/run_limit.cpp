#include "core/scene/run_limit.h"

#include <sstream>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/scene/particle_limit.h"

namespace migiwa {

namespace {

/// Quotients of decimal numbers miss whole ones by what a double cannot hold.
constexpr double kRounding = 1e-9;

bool tooMany(double steps) {
  return !(steps <= kMostSteps * (1 + kRounding));
}

std::string ofSubsteps(const SolverParameters& solver) {
  return solver.substeps > 1 ? " in " + std::to_string(solver.substeps) + " substeps each" : "";
}

/// The latest time (s) by which there are at most so many particles; nothing when there are more from the
/// start.
std::optional<double> latestEnd(const Scene& scene, double until, double most) {
  double fits = 0, beyond = until;
  if (particleCount(scene, scene.particleSpacing, fits) > most) return std::nullopt;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (fits + beyond);
    (particleCount(scene, scene.particleSpacing, middle) > most ? beyond : fits) = middle;
  }
  return fits > 0 ? shownRoundedDown(fits) : 0;
}

}  // namespace

double fewestSteps(const SolverParameters& solver, double time) {
  return time / solver.timeStep * solver.substeps;
}

std::optional<std::string> tooShortStep(const SolverParameters& solver, double duration) {
  const double steps = fewestSteps(solver, duration);
  if (!tooMany(steps)) return std::nullopt;
  std::ostringstream text;
  text << "expected at least " << shownRoundedUp(duration * solver.substeps / kMostSteps) << " s"
       << ofSubsteps(solver) << ", with which the " << duration << " s of duration take at most "
       << kMostSteps << " steps, found " << solver.timeStep << " s, which takes " << steps
       << "; a shorter duration takes fewer, too";
  return text.str();
}

std::optional<std::string> tooLateAnEnd(const Scene& scene, double until, double memory) {
  std::ostringstream text;
  if (const double steps = fewestSteps(scene.solver, until); tooMany(steps)) {
    text << "expected at most "
         << shownRoundedDown(kMostSteps * scene.solver.timeStep / scene.solver.substeps) << " s, "
         << kMostSteps << " steps of " << scene.solver.timeStep << " s" << ofSubsteps(scene.solver)
         << ", found " << until << " s, which takes " << steps << "; a longer time_step takes fewer";
    return text.str();
  }
  const double particles = particleCount(scene, scene.particleSpacing, until), most = mostParticles(memory);
  if (particles <= most) return std::nullopt;
  text << "expected an end by which there are at most " << most << " particles, found " << until
       << " s, by which emitters make them " << particles;
  if (const std::optional<double> latest = latestEnd(scene, until, most))
    text << "; an end of " << *latest << " s would do, and so would fewer \"particles\" of the emitters";
  text << "; a larger particle_spacing makes fewer";
  return text.str();
}

void requireReachable(const Scene& scene, double until, const std::string& option) {
  if (const auto fault = tooLateAnEnd(scene, until, availableMemory())) throw InputError(option, *fault);
}

}  // namespace migiwa
