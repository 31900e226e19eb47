// The energy of the fluid over a run against what was put in: by moving walls, by emitters and by effects.
// What remains is the doing of the solver, which may take energy away but has none to give, save what it
// finds stored in fluid that is too dense. Definitions in core/solver/energy.h.
#pragma once

#include <vector>

#include "core/solver/energy.h"

namespace migiwa {

class StateVisitor;
struct StepState;

/// Energies over the mass of all particles that there are (J/kg), at one time.
struct EnergySample {
  double time = 0;  ///< (s)
  double kinetic = 0, potential = 0;
  double source = 0;  ///< the energy of the start, and what walls, emitters and effects have given since
};

/// All energies here are sums over particles of energy over mass (m^2/s^2): times the mass of a particle they
/// are joules.
struct EnergyBalance {
  double start = 0;       ///< kinetic and potential energy at the start
  double kinetic = 0;     ///< now
  double potential = 0;   ///< now
  double walls = 0;       ///< work of moving walls so far
  double emitters = 0;    ///< energy of what emitters have given so far, as it was given
  double effects = 0;     ///< work of effects so far: negative where they brake
  double solver = 0;      ///< what the solver has changed so far: negative, for it dissipates
  double mostGained = 0;  ///< the largest that `solver` over the number of particles ever was (m^2/s^2)
  double stored = 0;      ///< at the start, see storedEnergy()
  double head = 0;  ///< g H/2 of the start: what water lifts itself by as it swells, over its density error
                    ///< (m^2/s^2, a mean)
  double elastic = 0;                 ///< what the next step may give back, see beginStep()
  std::vector<EnergySample> history;  ///< at most kMostSamples of them, evenly spread over the steps

  static constexpr std::size_t kMostSamples = 256;

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
  /// A step of `dt` (s) that came from `before`, with what emitters gave at its start.
  void record(const StepState& state, const EnergySums& before, const EnergySums& now, double dt,
              double time);
  /// For a save.
  void visit(StateVisitor& visitor);

 private:
  /// What the step changed that neither walls nor effects did.
  static double bySolver(const StepState& state, const EnergySums& before, const EnergySums& now, double dt);
  void sample(double time, long particles);

  double undoing_ = 0;  ///< what undoing the density errors that the step finds may give (m^2/s^2)
  long stride_ = 1, untilSample_ = 0;
};

/// The kinetic energy over mass (m^2/s^2, a mean over particles) that fluid gets when one step of `dt` (s)
/// undoes its density errors C: C over the norm of its gradient is the way, that over dt the speed. The norm
/// is that of the resting lattice, and neighbours are taken not to push into each other's way: an estimate
/// within a factor of two. Fluid at its density at rest stores nothing.
double storedEnergy(const StepState& state, double dt);

}  // namespace migiwa
