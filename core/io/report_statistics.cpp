// From what a run counted to what a report says.
#include <algorithm>
#include <cmath>

#include <sys/resource.h>

#include "core/base/state_hash.h"
#include "core/boundary/gamma_method.h"
#include "core/io/report.h"

namespace migiwa {

namespace {

/// In joules; `mass` of a particle (kg).
void reportEnergy(const EnergyBalance& energy, double mass, Report& report) {
  report.energyStart = mass * energy.start;
  report.energyKinetic = mass * energy.kinetic;
  report.energyPotential = mass * energy.potential;
  report.energyWalls = mass * energy.walls;
  report.energyEmitters = mass * energy.emitters;
  report.energyEffects = mass * energy.effects;
  report.energyDissipated = -mass * energy.solver;
  report.energyGain = energy.mostGained;
  report.energyStored = energy.stored;
}

/// The value that a fraction `q` of all values does not exceed (nearest rank).
Measure quantile(std::vector<float> values, double q) {
  if (values.empty()) return std::nullopt;
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  const std::size_t at = std::max<std::size_t>(rank, 1) - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

Measure ratio(double value, double over) {
  return over > 0 ? Measure(value / over) : std::nullopt;
}

Measure milliseconds(Measure seconds) {
  return seconds ? Measure(1e3 * *seconds) : std::nullopt;
}

double iterationSeconds(const StageTimes& stages) {
  return stages.seconds("lambda") + stages.seconds("position") + stages.seconds("projection") +
         stages.seconds("gamma_refresh");
}

double peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

}  // namespace

Report makeReport(const Simulation& simulation, const SettledMeasures& settled,
                  const std::vector<Override>& overrides) {
  const RunStatistics& run = simulation.statistics();
  const auto steps = static_cast<double>(run.steps);
  const auto particles = static_cast<double>(simulation.view().positions.size());
  const BoundaryParameters boundary = simulation.settings().boundary;

  Report report;
  report.scene = simulation.scene().file.string();
  for (const Override& override : overrides)
    report.overrides.push_back(override.pointer + "=" + override.value);
  report.steps = steps;
  report.simulatedSeconds = run.simulatedSeconds;
  report.wallSeconds = run.wallSeconds;
  report.threads = simulation.threads();
  report.particles = particles;
  report.stateHash = hexDigits(simulation.stateHash());
  report.handling = handlingNames()[static_cast<std::size_t>(boundary.handling)];
  report.gammaMethod = run.gammaPicked;
  report.gammaReason = run.gammaReason;
  report.stepMedian = milliseconds(quantile(run.stepSeconds, 0.5));
  report.stepP95 = milliseconds(quantile(run.stepSeconds, 0.95));
  for (const StageTime& stage : run.stages.stages())
    report.stages.push_back({stage.name, stage.seconds / std::max(steps, 1.0)});
  report.nanosecondsPerParticleIteration =
      ratio(1e9 * iterationSeconds(run.stages), particles * run.iterationSum);
  report.iterationsMean = ratio(run.iterationSum, steps);
  report.iterationsMax = run.iterationMax;
  report.densityErrorMean = ratio(run.densityErrorSum, steps);
  report.densityErrorMax = run.densityErrorMax;
  report.lostParticles = static_cast<double>(run.lostParticles);
  report.nonfiniteParticles = static_cast<double>(run.nonfiniteParticles);
  report.maxPenetration = run.maxPenetration;
  report.maxSpeed = run.maxSpeed;
  report.peakMemoryBytes = peakMemory();
  const double spacing = simulation.scene().particleSpacing;
  reportEnergy(run.energy, simulation.settings().solver.restDensity * spacing * spacing * spacing, report);
  report.trouble = run.trouble;
  report.settled = settled;
  return report;
}

}  // namespace migiwa
