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

void RunStatistics::noteRepairs(const StepState& state, long step) {
  if (state.spreadParticles > 0) {
    note("heap", step,
         std::to_string(state.spreadParticles) +
             " particles lay in overfull cells; they were spread without gaining speed");
  }
  if (state.gammaOutOfRange > 0) {
    note("gamma_range", step,
         std::to_string(state.gammaOutOfRange) +
             " evaluations of gamma were out of [0, 1] and were set to its end, as where walls overlap");
  }
}

void RunStatistics::record(const StepState& state, const Health& health, double dt, double seconds) {
  ++steps;
  simulatedSeconds += dt;
  wallSeconds += seconds;
  stepSeconds.push_back(static_cast<float>(seconds));
  stages.add(state.times);
  iterationSum += state.iterations;
  pressureIterationSum += state.parameters.solvesDivergence() ? state.pressureIterations : 0;
  particleIterationSum += static_cast<double>(state.particles.size()) * state.iterations;
  iterationMax = std::max(iterationMax, state.iterations);
  const IterationError& error = state.errors.back();
  densityErrorSum += error.mean;
  densityErrorMax = std::max(densityErrorMax, error.max);
  maxPenetration = std::max(maxPenetration, static_cast<double>(health.maxPenetration));
  maxSpeed = std::max(maxSpeed, static_cast<double>(health.maxSpeed));
  lostParticles = health.lost;
  nonfiniteParticles = health.nonfinite;

  const SolverParameters& asked = state.parameters;
  const bool twoSolves = asked.method == SolverMethod::dfsph;
  // Of DFSPH errors hold the density before its solves.
  const double left = twoSolves ? state.densityLeft : error.mean;
  if (twoSolves && state.divergenceLeft > asked.divergenceTolerance &&
      state.pressureIterations >= asked.maxPressureIterations) {
    note("not_converged", steps,
         "mean divergence times the step " + std::to_string(state.divergenceLeft) + " after " +
             std::to_string(state.pressureIterations) + " iterations, divergence_tolerance " +
             std::to_string(asked.divergenceTolerance));
  }
  if (left > asked.tolerance && state.iterations >= asked.maxIterations) {
    note("not_converged", steps,
         "mean density error " + std::to_string(left) + " after " + std::to_string(state.iterations) +
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
  noteRepairs(state, steps);
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
    const long thrown = health.thrown, past = health.lost - thrown;
    std::string what;
    if (past > 0) what = std::to_string(past) + " particles are past a wall by more than a spacing";
    if (thrown > 0)
      what += (past > 0 ? ", " : "") + std::to_string(thrown) +
              " particles left the scene faster than anything in it could have made them";
    note("lost_particle", steps, what + "; particle " + std::to_string(health.firstBad) + " is among them");
  }
}

void RunStatistics::visit(StateVisitor& visitor) {
  visitor.integer("/statistics/steps", steps);
  visitor.number("/statistics/simulated_s", simulatedSeconds);
  visitor.number("/statistics/wall_s", wallSeconds);
  visitor.number("/statistics/iterations/sum", iterationSum);
  visitor.number("/statistics/iterations/pressure_sum", pressureIterationSum);
  visitor.number("/statistics/iterations/with_particles", particleIterationSum);
  visitor.integer("/statistics/iterations/max", iterationMax);
  visitor.number("/statistics/density_error/sum", densityErrorSum);
  visitor.number("/statistics/density_error/max", densityErrorMax);
  visitor.number("/statistics/max_penetration", maxPenetration);
  visitor.number("/statistics/max_speed", maxSpeed);
  visitor.array("statistics/step_seconds", stepSeconds);
  fluid.visit(visitor);
  energy.visit(visitor);
  for (std::size_t k = 0; k < gauges.size(); ++k) gauges[k].visit(visitor, "/gauges/" + std::to_string(k));

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
  limits.domain = scene.domainBounds();
  limits.domainGrows = !scene.domain.given;
  limits.gravity = scene.gravity;
  limits.slow = scene.particleSpacing / scene.solver.timeStep * scene.solver.substeps;
  for (const auto& source : scene.fluid) limits.given = std::max(limits.given, source->largestSpeed());
  for (const Emitter& emitter : scene.emitters) limits.given = std::max(limits.given, emitter.mouthSpeed());
  if (const Bounds bounds = scene.bounds(); !bounds.empty()) {
    limits.centre = bounds.center().cast<float>();
    limits.farthest = bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).norm();
    limits.top = scene.gravity.dot(bounds.center()) - 0.5 * scene.gravity.cwiseAbs().dot(bounds.size());
  }
  return limits;
}

double HealthLimits::fastest(const Vec3d& p) const {
  constexpr double kJets = 4;
  const double fallen = std::max(0.0, gravity.dot(p) - top);
  return kJets * std::sqrt(given * given + 2 * fallen) + slow;
}

Health inspect(const StepState& state, const HealthLimits& limits) {
  const Particles& particles = state.particles;
  return parallelReduce(
      state.pool, particles.size(), Health{},
      [&](std::size_t begin, std::size_t end) {
        Health part;
        float fastest2 = 0, farthest2 = 0;
        for (std::size_t i = begin; i < end; ++i) {
          const Vec3f position = particles.position[i].xyz(), velocity = particles.velocity[i].xyz();
          if (!position.allFinite() || !velocity.allFinite()) {
            ++part.nonfinite;
            part.firstBad = particles.id[i];
            continue;
          }
          fastest2 = std::max(fastest2, velocity.squaredNorm());
          farthest2 = std::max(farthest2, position.squaredNorm());
          part.energy.add(position, velocity, limits.centre);
          const bool clear = particles.position[i].w > 0;
          const float penetration = clear ? 0 : -state.boundary.distance(position);
          part.maxPenetration = std::max(part.maxPenetration, penetration);
          bool lost = static_cast<double>(penetration) > limits.mostPenetration;
          const Vec3d place = position.cast<double>();
          if (!limits.domain.empty() && !limits.domain.contains(place)) {
            ++part.outside;
            const bool thrown = !lost && static_cast<double>(velocity.norm()) > limits.fastest(place);
            if (thrown) ++part.thrown;
            lost = lost || thrown;
          }
          if (lost) {
            ++part.lost;
            part.firstBad = particles.id[i];
          }
        }
        part.maxSpeed = std::sqrt(fastest2), part.farthest = std::sqrt(farthest2);
        return part;
      },
      [](Health a, const Health& b) {
        if (a.lost + a.nonfinite == 0) a.firstBad = b.firstBad;
        a.maxSpeed = std::max(a.maxSpeed, b.maxSpeed);
        a.farthest = std::max(a.farthest, b.farthest);
        a.maxPenetration = std::max(a.maxPenetration, b.maxPenetration);
        a.energy += b.energy;
        a.outside += b.outside;
        a.lost += b.lost;
        a.thrown += b.thrown;
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

void EnergyBalance::takeOut(const EnergySums& sums, const Vec3d& gravity) {
  outflow -= sums.kinetic + sums.potential(gravity);
  gone += sums.particles;
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
  const std::int64_t all = now.particles + gone;
  if (all > 0) mostGained = std::max(mostGained, solver / static_cast<double>(all));
  sample(time, now.particles);
}

void EnergyBalance::sample(double time, long particles) {
  const double share = particles > 0 ? 1 / static_cast<double>(particles) : 0;
  const double source = start + walls + emitters + outflow + effects;
  thinning_.add(history, {time, kinetic * share, potential * share, source * share});
}

void Thinning::visit(StateVisitor& visitor, const std::string& name) {
  visitor.integer(name + "/stride", stride_);
  visitor.integer(name + "/until_sample", untilSample_);
}

void EnergyBalance::visit(StateVisitor& visitor) {
  visitor.number("/energy/start", start);
  visitor.number("/energy/kinetic", kinetic);
  visitor.number("/energy/potential", potential);
  visitor.number("/energy/walls", walls);
  visitor.number("/energy/emitters", emitters);
  visitor.number("/energy/outflow", outflow);
  visitor.number("/energy/effects", effects);
  visitor.number("/energy/solver", solver);
  visitor.number("/energy/most_gained", mostGained);
  visitor.number("/energy/stored", stored);
  visitor.number("/energy/head", head);
  visitor.number("/energy/elastic", elastic);
  visitor.integer("/energy/gone", gone);
  thinning_.visit(visitor, "/energy");
  visitor.array("energy/history", history);
}

}  // namespace migiwa
