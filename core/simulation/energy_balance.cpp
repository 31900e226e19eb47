#include "core/simulation/energy_balance.h"

#include <algorithm>

#include "core/simulation/state_visitor.h"
#include "core/solver/step_state.h"

namespace migiwa {

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
