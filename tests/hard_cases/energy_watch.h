// Energy of a run as a spectator sees it: from the positions and velocities of each frame, and from
// mechanics.
#pragma once

#include "core/simulation/simulation.h"

namespace migiwa::testing {

struct Observed;

/// Kinetic and potential energy over the mass (J/kg) at the end of each frame. The step is symplectic Euler,
/// whose velocities belong to the middle of the step: with v + g dt/2 what flies free keeps its energy. Where
/// walls stand still and nobody emits, nothing gives any, and the energy may never be above the start's by
/// more than its start has stored and rounding makes.
class EnergyWatch {
 public:
  /// The start; `simulation` has to outlive it.
  explicit EnergyWatch(const Simulation& simulation);
  /// The end of a frame.
  void look();
  /// Most that the energy ever rose above the start's, half a step on (J/kg).
  double mostGained() const { return gained_; }
  /// Most that it ever rose above what it had been before (J/kg): energy that was gone comes back.
  double mostRegained() const { return regained_; }
  /// Of fluid whose density errors C of the start are undone in one step, (C h/dt)^2 over the sum of squared
  /// gradients of the resting lattice is the kinetic energy, an estimate within a factor of two; water of the
  /// height H that swells by the largest C lifts itself by g H/2 of it. What touches a wall may gain the
  /// speed that gravity gives in one step. Velocities are differences of positions, which are rounded: errors
  /// of steps that do not know of each other. And steps that change their length are no longer symplectic:
  /// half the change of fall.
  double bound() const;
  void finish(Observed& seen) const;

 private:
  struct Range {
    double low = 0, high = 0;
  };
  /// With the last step's length, which a frame of several may hide, from half of their mean up to twice
  /// that.
  Range energyNow(double meanStep) const;
  double rounding() const;

  const Simulation& simulation_;
  long steps_ = 0, startParticles_ = 0;
  double start_ = 0, stored_ = 0, lift_ = 0, squares_ = 0;
  double halfStep_ = 0;
  Vec3d startVelocity_ = Vec3d::Zero();
  bool divided_ = false;
  double lastStep_ = 0, changes_ = 0;  ///< of the mean step of a frame (s), and how much it changed in all
  double lowest_ = 0, gained_ = 0, regained_ = 0, off_ = 0;
};

}  // namespace migiwa::testing
