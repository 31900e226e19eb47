#include "core/simulation/statistics.h"

#include <algorithm>
#include <cmath>

#include "core/simulation/state.h"
#include "core/solver/state.h"

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
           " particles lay in overfull cells; they were spread without gaining speed");
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
  if (!state.suppressedPushes.empty()) {
    note("wall_jump", steps,
         std::to_string(state.suppressedPushes.size()) +
             " times a wall pushed a particle further than it had moved; the push added no speed");
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

double storedEnergy(const StepState& state, double dt) {
  if (state.errors.empty() || dt <= 0) return 0;
  const double way2 = state.errors.back().meanSquare * static_cast<double>(state.supportRadius) *
                      static_cast<double>(state.supportRadius) /
                      static_cast<double>(state.lattice.squaredGradients);
  return 0.5 * way2 / (dt * dt);
}

void EnergyBalance::begin(const EnergySums& sums, const StepState& state, double height) {
  head = 0.5 * static_cast<double>(state.gravity.norm()) * height;
  kinetic = sums.kinetic;
  potential = sums.potential(state.gravity.cast<double>());
  start = kinetic + potential;
  sample(0, sums.particles);
}

double EnergyBalance::bySolver(const StepState& state, const EnergySums& before, const EnergySums& now,
                               double dt) {
  const Vec3d gravity = state.gravity.cast<double>();
  return now.halfStepOn(gravity, dt) - before.halfStepOn(gravity, dt) - state.wallWork.sum() / dt -
         state.effectWork;
}

void EnergyBalance::beginStep(const StepState& state, long particles, double dt, bool first) {
  constexpr double kKept = 7.0 / 8;
  if (first) stored = storedEnergy(state, dt);
  undoing_ = static_cast<double>(particles) * (2 * storedEnergy(state, dt) + head * state.errors.back().max);
  if (first) elastic = undoing_;
  if (elastic > undoing_) elastic = std::max(undoing_, kKept * elastic);
}

double EnergyBalance::excess(const StepState& state, const EnergySums& before, const EnergySums& now,
                             double dt, double rounding) const {
  const double gained = bySolver(state, before, now, dt),
               speedUp = dt * static_cast<double>(state.gravity.norm());
  if (gained <= 0) return 0;
  constexpr double kOfKinetic = 0.05;
  const double most = std::min(elastic, std::max(undoing_, kOfKinetic * before.kinetic));
  const double slack = static_cast<double>(now.particles) * (0.5 * speedUp * speedUp + rounding);
  return gained > most + slack ? gained - most : 0;
}

void EnergyBalance::record(const StepState& state, const EnergySums& before, const EnergySums& now, double dt,
                           double time) {
  const Vec3d gravity = state.gravity.cast<double>();
  const double byWalls = state.wallWork.sum() / dt;
  kinetic = now.kinetic;
  potential = now.potential(gravity);
  walls += byWalls;
  effects += state.effectWork;
  const double gained = bySolver(state, before, now, dt);
  solver += gained;
  elastic = std::max(0.0, elastic - gained);
  if (now.particles > 0) {
    mostGained = std::max(mostGained, solver / static_cast<double>(now.particles));
  }
  sample(time, now.particles);
}

void EnergyBalance::sample(double time, long particles) {
  if (untilSample_-- > 0) return;
  if (history.size() == kMostSamples) {
    // Twice as far apart from now on: every second one stays.
    for (std::size_t k = 0; 2 * k < history.size(); ++k) history[k] = history[2 * k];
    history.resize(kMostSamples / 2);
    stride_ *= 2;
  }
  untilSample_ = stride_ - 1;
  const double share = particles > 0 ? 1 / static_cast<double>(particles) : 0;
  history.push_back({time, kinetic * share, potential * share, (start + walls + emitters + effects) * share});
}

void EnergyBalance::visit(StateVisitor& visitor) {
  visitor.number("/energy/start", start);
  visitor.number("/energy/kinetic", kinetic);
  visitor.number("/energy/potential", potential);
  visitor.number("/energy/walls", walls);
  visitor.number("/energy/emitters", emitters);
  visitor.number("/energy/effects", effects);
  visitor.number("/energy/solver", solver);
  visitor.number("/energy/most_gained", mostGained);
  visitor.number("/energy/stored", stored);
  visitor.number("/energy/head", head);
  visitor.number("/energy/elastic", elastic);
  std::int64_t stride = stride_, until = untilSample_;
  visitor.integer("/energy/stride", stride);
  visitor.integer("/energy/until_sample", until);
  stride_ = stride, untilSample_ = until;
  visitor.array("energy/history", history);
}

}  // namespace migiwa
