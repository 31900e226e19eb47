// What a run did, as the JSON file that `--report` writes and `migiwa summary` reads. The keys are an
// interface that people script against: add to them, rename none.
//
// Meanings: `steps` and `step_ms` count substeps; `stages_ms` are milliseconds a substep;
// `ns_per_particle_iteration` is the time of lambda (error reduction included), position, projection and
// gamma_refresh over particles times iterations; density errors are max(rho/rho0 - 1, 0) after the last
// iteration of a substep.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene_file.h"
#include "core/simulation/measures.h"
#include "core/simulation/simulation.h"

namespace migiwa {

/// A number that is null in the file where there is nothing to measure, or where it is not finite.
using Measure = std::optional<double>;

/// What a drain has taken over time.
struct DrainReport {
  Measure particles, volume;           ///< (m^3)
  std::vector<double> times, volumes;  ///< taken by that time (s, m^3)
};

/// What a gauge has shown over time.
struct GaugeReport {
  std::string name, kind, unit;
  std::vector<double> times, values;  ///< (s, unit)
};

struct Report {
  std::string scene;                   ///< the scene file as it was given
  std::vector<std::string> overrides;  ///< `/json/pointer=VALUE`, in order
  Measure steps, simulatedSeconds, wallSeconds, threads, particles;
  std::string stateHash;  ///< 16 hex digits
  std::string handling, gammaMethod, gammaReason;
  Measure stepMedian, stepP95;              ///< (ms)
  std::vector<StageTime> stages;            ///< seconds a substep
  Measure nanosecondsPerParticleIteration;  ///< (ns)
  Measure iterationsMean, iterationsMax, pressureIterationsMean;
  Measure densityErrorMean, densityErrorMax;
  Measure lostParticles, nonfiniteParticles;
  /// started + emitted = particles + left + drained; the lost ones are among the particles.
  Measure startedParticles, emittedParticles, leftParticles, leftVolume, drainedParticles, drainedVolume;
  std::vector<DrainReport> drains;  ///< in the order of the scene
  std::vector<GaugeReport> gauges;  ///< in the order of the scene
  Measure maxPenetration;           ///< (m)
  Measure maxSpeed;                 ///< (m/s)
  Measure peakMemoryBytes;          ///< of the whole program
  /// Energies (J): at the start and at the end, what was given since, and what the solver took.
  Measure energyStart, energyKinetic, energyPotential, energyWalls, energyEmitters, energyOutflow,
      energyEffects, energyDissipated;
  Measure energyGain;    ///< the most that the solver had ever added, over the mass (J/kg)
  Measure energyStored;  ///< in the density errors of the start, over the mass (J/kg)
  std::vector<Trouble> trouble;
  SettledMeasures settled;
};

/// `overrides` are those that the scene was read with.
Report makeReport(const Simulation& simulation, const SettledMeasures& settled,
                  const std::vector<Override>& overrides);

std::string reportText(const Report& report);

/// The gauges as CSV: a row for each time, a column `NAME (UNIT)` for each gauge, empty where it had nothing
/// to measure.
std::string gaugesCsv(const Report& report);

/// Throws InputError with every fault. Keys that a report does not have are null, so that old reports stay
/// readable.
Report readReport(const std::filesystem::path& file);

}  // namespace migiwa
