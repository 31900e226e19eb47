// What happened in a run: statistics, trouble, and the balance of energy.
#pragma once

#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/scene/scene.h"
#include "core/solver/energy.h"
#include "core/solver/state.h"

namespace migiwa {

// Histories that stay short however long a run is.

class StateVisitor;

/// Evenly spread samples: where there are too many, every second one stays, and as few are taken from then
/// on.
class Thinning {
 public:
  static constexpr std::size_t kMostSamples = 256;

  explicit Thinning(std::size_t most = kMostSamples) : most_(most) {}

  /// A step has been taken, after which `sample` says how things are.
  template <class Sample>
  void add(std::vector<Sample>& history, const Sample& sample) {
    if (untilSample_-- > 0) return;
    if (history.size() == most_) {
      for (std::size_t k = 0; 2 * k < history.size(); ++k) history[k] = history[2 * k];
      history.resize(most_ / 2);
      stride_ *= 2;
    }
    untilSample_ = stride_ - 1;
    history.push_back(sample);
  }
  /// For a save; `name` such as "/energy".
  void visit(StateVisitor& visitor, const std::string& name);

 private:
  std::size_t most_;
  std::int64_t stride_ = 1, untilSample_ = 0;
};

// How many particles came into the fluid and went out of it: started + emitted = those that there are + left
// + drained.

/// What a drain had taken by a time.
struct DrainSample {
  double time = 0;  ///< (s)
  std::int64_t particles = 0;
};

struct DrainTally {
  std::int64_t particles = 0;        ///< taken so far
  std::vector<DrainSample> history;  ///< see Thinning
  Thinning thinning;
};

struct FluidBalance {
  std::int64_t started = 0;        ///< at the start
  std::int64_t emitted = 0;        ///< by emitters, since then
  std::int64_t left = 0;           ///< out of the scene's bounds
  std::vector<DrainTally> drains;  ///< in the order of the scene

  /// All that ever were: the id of the next one.
  std::int64_t made() const { return started + emitted; }
  std::int64_t drained() const;
  /// After a step, at `time` (s).
  void sample(double time);
  /// For a save.
  void visit(StateVisitor& visitor);
};

// What the gauges of a scene have shown.

struct GaugeSample {
  double time = 0;   ///< (s)
  double value = 0;  ///< in the unit of the gauge
};

/// The start, where there is something to measure, and the end of every frame.
struct GaugeSeries {
  /// A wave and the peak of an impact keep their shape; a run of more frames is thinned.
  static constexpr std::size_t kMostSamples = 16384;

  std::vector<GaugeSample> history;
  Thinning thinning{kMostSamples};

  void add(double time, double value) { thinning.add(history, GaugeSample{time, value}); }
  /// As few of the samples as a picture needs, the last one among them.
  std::vector<GaugeSample> few() const;
  /// For a save; `name` such as "/gauges/0".
  void visit(StateVisitor& visitor, const std::string& name);
};

// The energy of the fluid over a run against what was put in: by moving walls, by emitters and by effects.
// What remains is the doing of the solver, which may take energy away but has none to give, save what it
// finds stored in fluid that is too dense. Definitions in core/solver/energy.h.

struct StepState;

/// Energies over the mass of all particles that there are (J/kg), at one time.
struct EnergySample {
  double time = 0;  ///< (s)
  double kinetic = 0, potential = 0;
  double source = 0;  ///< the energy of the start, and what walls, emitters and effects have given since,
                      ///< less that of fluid that is gone
};

/// All energies here are sums over particles of energy over mass (m^2/s^2): times the mass of a particle they
/// are joules.
struct EnergyBalance {
  double start = 0;       ///< kinetic and potential energy at the start
  double kinetic = 0;     ///< now
  double potential = 0;   ///< now
  double walls = 0;       ///< work of moving walls so far
  double emitters = 0;    ///< energy of what emitters have given so far, as it was given
  double outflow = 0;     ///< energy of what has left or was drained, as it went, with a minus
  double effects = 0;     ///< work of effects so far: negative where they brake
  double solver = 0;      ///< what the solver has changed so far: negative, for it dissipates
  double mostGained = 0;  ///< the largest that `solver` over the particles, gone ones included, ever was
                          ///< (m^2/s^2)
  double stored = 0;      ///< at the start, see storedEnergy()
  double head = 0;  ///< g H/2 of the start: what water lifts itself by as it swells, over its density error
                    ///< (m^2/s^2, a mean)
  double elastic = 0;                 ///< what the next step may give back, see beginStep()
  std::int64_t gone = 0;              ///< particles that have left or were drained
  std::vector<EnergySample> history;  ///< evenly spread over the steps, see Thinning

  /// The state before the first step; `height` (m) is that of the fluid along gravity.
  void begin(const EnergySums& sums, const StepState& state, double height);
  /// A step of `dt` (s) is about to be taken. It may give back what earlier ones took out of motion and left
  /// in density errors, no more than their undoing gives: 2 storedEnergy(), an estimate within a factor of
  /// two, and what water lifts itself by as it swells. An impact takes several steps, in which what flies
  /// apart comes together again, so that what is above is not gone at once: it fades by an eighth a step.
  /// Long before is forgotten, however much has been dissipated. The first step finds all that the start has
  /// stored.
  void beginStep(const StepState& state, long particles, double dt, bool first);
  /// What is to be taken back of a step of `dt` (s) (m^2/s^2, a sum over the particles), 0 where it added
  /// nothing or kept within what beginStep() says; beyond the undoing of density errors it may add a
  /// twentieth of the kinetic energy. Let pass is what gravity gives a particle in one step at a wall, and
  /// `rounding` (m^2/s^2, a mean over particles).
  double excess(const StepState& state, const EnergySums& before, const EnergySums& now, double dt,
                double rounding) const;
  /// Fluid that goes, with the energy that it has.
  void takeOut(const EnergySums& sums, const Vec3d& gravity);
  /// A step of `dt` (s) that came from `before`, with what emitters gave and less what went at its start.
  void record(const StepState& state, const EnergySums& before, const EnergySums& now, double dt,
              double time);
  /// For a save.
  void visit(StateVisitor& visitor);

 private:
  /// What the step changed that neither walls nor effects did.
  static double bySolver(const StepState& state, const EnergySums& before, const EnergySums& now, double dt);
  void sample(double time, long particles);

  double undoing_ = 0;  ///< what undoing the density errors that the step finds may give (m^2/s^2)
  Thinning thinning_;
};

/// The kinetic energy over mass (m^2/s^2, a mean over particles) that fluid gets when one step of `dt` (s)
/// undoes its density errors C: C over the norm of its gradient is the way, that over dt the speed. The norm
/// is that of the resting lattice, and neighbours are taken not to push into each other's way: an estimate
/// within a factor of two. Fluid at its density at rest stores nothing.
double storedEnergy(const StepState& state, double dt);

// What is counted while a simulation runs; the report (core/io/report.h) writes it down. Names and meanings
// are those of the report's keys.

struct Health;

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
  double pressureIterationSum = 0;  ///< of projections
  double particleIterationSum = 0;  ///< sum over substeps of particles times iterations
  int iterationMax = 0;
  double densityErrorSum = 0;  ///< sum over substeps of the mean over particles
  double densityErrorMax = 0;
  long lostParticles = 0;
  long nonfiniteParticles = 0;
  bool overConstrained = false;  ///< walls left the fluid no room
  double maxPenetration = 0;     ///< (m)
  double maxSpeed = 0;           ///< (m/s)
  FluidBalance fluid;
  EnergyBalance energy;
  std::vector<GaugeSeries> gauges;  ///< in the order of the scene
  std::string gammaPicked;          ///< the gamma method that runs; empty without correction
  std::string gammaReason;          ///< why "auto" took it; empty when the scene names it
  std::vector<Trouble> trouble;

  void note(const std::string& kind, long step, const std::string& detail);
  /// Notes particles that were spread off overfull cells and shares of the kernel that were out of range, if
  /// there are any.
  void noteRepairs(const StepState& state, long step);
  /// Takes in a finished substep of `dt` (s) that took `seconds` of wall time.
  void record(const StepState& state, const Health& health, double dt, double seconds);
  /// All of it for a save, but for gammaPicked and gammaReason, which follow from the scene.
  void visit(StateVisitor& visitor);
  /// Non-finite state, lost particles or no room for the fluid: exit code 3.
  bool failed() const { return lostParticles > 0 || nonfiniteParticles > 0 || overConstrained; }
};

// What a step's end looks like: finite or not, how fast, how far past the walls.

struct HealthLimits {
  double mostPenetration = 0;  ///< past a wall by more than this (m) is lost: one spacing
  Bounds domain;               ///< out of this a particle leaves; empty: everywhere is in it
  bool domainGrows = true;     ///< with walls that move: unless the scene says where it ends
  double given = 0;            ///< largest speed that sources, emitters and walls have given any fluid (m/s)
  double slow = 0;             ///< speed that rounding and a step's corrections alone may leave (m/s)
  Vec3d gravity = Vec3d::Zero();  ///< (m/s^2)
  double top = 0;       ///< least of gravity . x within the scene's extent: its highest place (m^2/s^2)
  double farthest = 0;  ///< coordinate of the scene (m), whose rounding velocities bear
  Vec3f centre = Vec3f::Zero();  ///< of the scene at its start: where potential energy is zero (m)

  /// What leaves faster (m/s) than this at p (m) was thrown by nothing but a step that has gone wrong. Water
  /// that falls from the highest place has the speed of a free fall; where jets meet, some of it has a
  /// multiple.
  double fastest(const Vec3d& p) const;
};
HealthLimits healthLimits(const Scene& scene);

struct Health {
  float maxSpeed = 0;        ///< (m/s)
  float farthest = 0;        ///< from the origin (m)
  float maxPenetration = 0;  ///< (m)
  long outside = 0;          ///< of the domain: they leave before the next step
  long lost = 0;             ///< past a wall, or `thrown`
  long thrown = 0;           ///< outside faster than anything could have made them
  long nonfinite = 0;
  EnergySums energy;           ///< of the finite particles
  std::uint32_t firstBad = 0;  ///< id of a lost or non-finite particle, if there is one
};
Health inspect(const StepState& state, const HealthLimits& limits);

}  // namespace migiwa
