#include "core/solver/squeeze.h"

#include <algorithm>

#include "core/solver/pbf_solver.h"

namespace migiwa {

namespace {

bool tooDense(const IterationError& error) {
  return error.mean > kSqueezed || error.max > kCrowded;
}

/// The same walls and method, with the particles where the step would leave them.
void prepareTrial(const StepState& state, StepState& trial) {
  trial.thinWalls = state.thinWalls, trial.barringWalls = state.barringWalls;
  trial.gammaMethod = state.gammaMethod;
  trial.parameters = state.parameters;
  // Few iterations may be all that the scene allows a step, but they prove nothing.
  constexpr int kIterations = 50;
  trial.parameters.maxIterations = std::max(trial.parameters.maxIterations, kIterations);
  trial.spacing = state.spacing, trial.supportRadius = state.supportRadius;
  trial.lattice = state.lattice;
  trial.particles = state.particles;
  for (std::size_t i = 0; i < trial.particles.size(); ++i)
    trial.particles.position[i] = Float4(state.current[i].xyz());
}

}  // namespace

Squeeze findSqueeze(const StepState& state) {
  Squeeze squeeze;
  if (!tooDense(state.errors.back())) return squeeze;
  StepState trial(state.pool, state.boundary);
  prepareTrial(state, trial);
  relax(trial);
  const IterationError& left = trial.errors.back();
  squeeze.found = tooDense(left);
  squeeze.mean = left.mean, squeeze.largest = left.max;
  const auto densest = std::max_element(trial.density.begin(), trial.density.end());
  squeeze.place = trial.particles.position[static_cast<std::size_t>(densest - trial.density.begin())].xyz();
  return squeeze;
}

}  // namespace migiwa
