// What is counted while a simulation runs; the report (core/io/report.h) writes it down. Names and meanings
// are those of the report's keys.
#pragma once

#include <string>
#include <vector>

#include "core/base/stage_times.h"
#include "core/simulation/energy_balance.h"

namespace migiwa {

class StateVisitor;
struct Health;
struct StepState;

/// One kind of numerical trouble: when it first happened, how often, and what was seen.
struct Trouble {
  std::string kind;  ///< such as "not_converged", "nonfinite", "lost_particle"
  long step = 0;     ///< first substep
  long count = 1;    ///< substeps that had it
  std::string detail;
};

struct RunStatistics {
  long steps = 0;
  double simulatedSeconds = 0;
  double wallSeconds = 0;
  std::vector<float> stepSeconds;  ///< wall time of each substep
  StageTimes stages;               ///< sums over the run
  double iterationSum = 0;
  int iterationMax = 0;
  double densityErrorSum = 0;  ///< sum over substeps of the mean over particles
  double densityErrorMax = 0;
  long lostParticles = 0;
  long nonfiniteParticles = 0;
  bool squeezed = false;      ///< walls left the fluid no room
  double maxPenetration = 0;  ///< (m)
  double maxSpeed = 0;        ///< (m/s)
  EnergyBalance energy;
  std::string gammaPicked;  ///< the gamma method that runs; empty without correction
  std::string gammaReason;  ///< why "auto" took it; empty when the scene names it
  std::vector<Trouble> trouble;

  void note(const std::string& kind, long step, const std::string& detail);
  /// Notes the particles that were spread off heaps, if there are any.
  void noteSpread(const StepState& state, long step);
  /// Takes in a finished substep of `dt` (s) that took `seconds` of wall time.
  void record(const StepState& state, const Health& health, double dt, double seconds);
  /// All of it for a save, but for gammaPicked and gammaReason, which follow from the scene.
  void visit(StateVisitor& visitor);
  /// Non-finite state, lost particles or no room for the fluid: exit code 3.
  bool failed() const { return lostParticles > 0 || nonfiniteParticles > 0 || squeezed; }
};

}  // namespace migiwa
