#include "core/simulation/statistics.h"

#include <algorithm>

#include "core/simulation/health.h"
#include "core/simulation/state_visitor.h"

namespace migiwa {

void RunStatistics::note(const std::string& kind, long step, const std::string& detail) {
  const auto known =
      std::find_if(trouble.begin(), trouble.end(), [&](const Trouble& t) { return t.kind == kind; });
  if (known != trouble.end()) {
    ++known->count;
  } else {
    trouble.push_back({kind, step, 1, detail});
  }
}

void RunStatistics::noteSpread(const StepState& state, long step) {
  if (state.spreadParticles == 0) return;
  note("heap", step,
       std::to_string(state.spreadParticles) +
           " particles lay on heaps, many where one has room; they were spread without gaining speed");
}

void RunStatistics::record(const StepState& state, const Health& health, double dt, double seconds) {
  ++steps;
  simulatedSeconds += dt;
  wallSeconds += seconds;
  stepSeconds.push_back(static_cast<float>(seconds));
  stages.add(state.times);
  iterationSum += state.iterations;
  iterationMax = std::max(iterationMax, state.iterations);
  const IterationError& error = state.errors.back();
  densityErrorSum += error.mean;
  densityErrorMax = std::max(densityErrorMax, error.max);
  maxPenetration = std::max(maxPenetration, static_cast<double>(health.maxPenetration));
  maxSpeed = std::max(maxSpeed, static_cast<double>(health.maxSpeed));
  lostParticles = health.lost;
  nonfiniteParticles = health.nonfinite;

  if (error.mean > state.parameters.tolerance) {
    note("not_converged", steps,
         "mean density error " + std::to_string(error.mean) + " after " + std::to_string(state.iterations) +
             " iterations, tolerance " + std::to_string(state.parameters.tolerance));
  }
  if (state.gammaFloored > 0) {
    note("gamma_floor", steps,
         std::to_string(state.gammaFloored) + " evaluations of gamma were below the floor");
  }
  if (!state.wallJumps.empty()) {
    note("wall_jump", steps,
         std::to_string(state.wallJumps.size()) +
             " times a wall pushed a particle further than it had come; no speed came of it");
  }
  noteSpread(state, steps);
  if (state.metCoincident) {
    note("coincident", steps,
         "pairs of particles lay on one point; their direction was taken from their ids");
  }
  if (health.nonfinite > 0) {
    note("nonfinite", steps,
         std::to_string(health.nonfinite) + " particles are not finite, particle " +
             std::to_string(health.firstBad) + " among them");
  }
  if (health.lost > 0) {
    note("lost_particle", steps,
         std::to_string(health.lost) + " particles left the scene, particle " +
             std::to_string(health.firstBad) + " among them");
  }
}

void RunStatistics::visit(StateVisitor& visitor) {
  visitor.integer("/statistics/steps", steps);
  visitor.number("/statistics/simulated_s", simulatedSeconds);
  visitor.number("/statistics/wall_s", wallSeconds);
  visitor.number("/statistics/iterations/sum", iterationSum);
  visitor.integer("/statistics/iterations/max", iterationMax);
  visitor.number("/statistics/density_error/sum", densityErrorSum);
  visitor.number("/statistics/density_error/max", densityErrorMax);
  visitor.number("/statistics/max_penetration", maxPenetration);
  visitor.number("/statistics/max_speed", maxSpeed);
  visitor.array("statistics/step_seconds", stepSeconds);
  energy.visit(visitor);

  std::vector<StageTime> times = stages.stages();
  auto count = static_cast<std::int64_t>(times.size());
  visitor.integer("/statistics/stages", count);
  times.resize(static_cast<std::size_t>(count));
  stages.clear();
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::string place = "/stage_" + std::to_string(k);
    visitor.text(place + "/name", times[k].name);
    visitor.number(place + "/seconds", times[k].seconds);
    stages.add(times[k].name, times[k].seconds);
  }

  count = static_cast<std::int64_t>(trouble.size());
  visitor.integer("/statistics/troubles", count);
  trouble.resize(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < trouble.size(); ++k) {
    const std::string place = "/trouble_" + std::to_string(k);
    visitor.text(place + "/kind", trouble[k].kind);
    visitor.integer(place + "/step", trouble[k].step);
    visitor.integer(place + "/count", trouble[k].count);
    visitor.text(place + "/detail", trouble[k].detail);
  }
}

}  // namespace migiwa
