// What the energy of the fluid is and who gives it any, so that "energy never grows without a source" can be
// checked of every step. Energies are sums over the particles of what each has over its mass (m^2/s^2).
//
// The step is symplectic Euler, whose velocities belong to the middle of the step that made them. With the
// velocity half a step on, v + g dt/2, a particle that flies free keeps its energy exactly, whatever the
// step:
//   H = sum 1/2 |v + g dt/2|^2 - g.x
// so what is left of a change of H is the doing of the solver, of moving walls and of effects.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/math.h"

namespace migiwa {

struct Particles;
struct StepState;

/// Sums over particles that the energy follows from, for any gravity and any step.
struct EnergySums {
  double kinetic = 0;              ///< of |v|^2/2 (m^2/s^2)
  Vec3d velocity = Vec3d::Zero();  ///< of v (m/s)
  Vec3d place = Vec3d::Zero();     ///< of x, counted from the scene's centre so that no digits are lost (m)
  long particles = 0;

  void add(const Vec3f& position, const Vec3f& velocityOfParticle, const Vec3f& centre) {
    kinetic += 0.5 * static_cast<double>(velocityOfParticle.squaredNorm());
    velocity += velocityOfParticle.cast<double>();
    place += Vec3f(position - centre).cast<double>();
    ++particles;
  }
  EnergySums& operator+=(const EnergySums& other);
  EnergySums& operator-=(const EnergySums& other);
  double potential(const Vec3d& gravity) const { return -gravity.dot(place); }
  /// H for a step of `dt` (s).
  double halfStepOn(const Vec3d& gravity, double dt) const;
};

/// Of the particles from `first` on.
EnergySums energySums(const Particles& particles, std::size_t first, const Vec3f& centre);

/// H, less a constant of the step, if the predicted positions were final.
double predictedEnergy(const StepState& state);
/// H, less the same constant, with the velocities as they are; positions play no part.
double velocityEnergy(const StepState& state);

/// Work that moving walls do in a step: their impulse on each particle times the wall's velocity there.
/// Impulses are displacements over the step, so this sums displacement times velocity (m^2/s). A linear
/// functional of the displacements, it takes part in the stretching of iterations as positions do.
class WallWork {
 public:
  void clear() { now_ = before_ = 0; }
  void add(double displacementTimesVelocity) { now_ += displacementTimesVelocity; }
  /// An iteration that the walls pushed by `displacementTimesVelocity`, stretched by `weight`.
  void iterate(double displacementTimesVelocity, float weight);
  double sum() const { return now_; }

 private:
  double now_ = 0, before_ = 0;
};

/// What the walls' push of the last stages::movePositions adds, before it is stretched.
double wallPush(const StepState& state);

/// The same of the pressure of a projection, for WallWork::add. Its gradient is made so that it is exact
/// beside walls, not out of the walls' push; that is what it has more than the sum of pairs, which give each
/// other what they take: grad phi_i - (m/rho0) sum_j (phi_i + phi_j) grad W_ij.
double projectionWork(const StepState& state);

// The pressure that a step's multipliers stand for. An iteration of PBF moves particles by
//   dx_i = sum_k lambda_k grad_i C_k,
// C being the relative compression. The work of a pressure p on a particle of volume V that is compressed by
// dC is -p V dC, so pressures p_k move a particle of the mass rho0 V in a step by
//   dx_i = -dt^2 / rho0 sum_k p_k grad_i C_k.
// Hence p = -rho0 sum lambda / dt^2, summed over the step's iterations: at rest this is rho0 g z at the
// depth z, near walls too, whatever gamma does to C there.

struct StepState;

// With a solver that has a pressure it is that; rho0 phi / dt with a projection. That is zero at the centres
// of the outermost particles, half a spacing below the surface that a pressure is zero at; so what is said of
// every particle is more by the pressure that its own gradient adds on half a spacing, at most that of
// gravity: at rest rho0 g z again, and nothing in free fall.

/// The pressure of each particle in a step. Off by default: with velocities from positions it is the sum over
/// the iterations, which takes part in their stretching as positions do and costs a pass over the particles
/// an iteration.
class PressureSum {
 public:
  void watch(bool on);
  bool watched() const { return watched_; }
  /// Forgets the last step.
  void clear();
  /// At the start of a step's iterations.
  void begin(const StepState& state);
  /// An iteration that moves particles by the multipliers in `state`, stretched by `weight`.
  void iterate(const StepState& state, float weight);
  /// A projection, with the length of its potential's gradient in `state.projection.image`.
  void project(const StepState& state);
  /// Pressure (Pa) of each particle in the step that `state` has just made; empty unless watched.
  void pressures(const StepState& state, std::vector<float>& out) const;

 private:
  bool watched_ = false;
  /// Sums of lambda over the squared support radius (1), or what a projection's p / rho0 is more (m^2/s^2).
  std::vector<float> now_, before_;
};

}  // namespace migiwa
