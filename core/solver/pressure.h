// The pressure that a step's multipliers stand for. An iteration of PBF moves particles by
//   dx_i = sum_k lambda_k grad_i C_k,
// C being the relative compression. The work of a pressure p on a particle of volume V that is compressed by
// dC is -p V dC, so pressures p_k move a particle of the mass rho0 V in a step by
//   dx_i = -dt^2 / rho0 sum_k p_k grad_i C_k.
// Hence p = -rho0 sum lambda / dt^2, summed over the step's iterations: at rest this is rho0 g z at the
// depth z, near walls too, whatever gamma does to C there.
#pragma once

#include <vector>

namespace migiwa {

struct StepState;

/// The sum over the iterations of a step, for each particle. As positions do, it takes part in the stretching
/// of iterations. Costs a pass over the particles an iteration, so nobody pays who does not ask.
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
  /// Pressure (Pa) of each particle in the step that `state` has just made; empty where nobody watched.
  void pressures(const StepState& state, std::vector<float>& out) const;

 private:
  bool watched_ = false;
  std::vector<float> now_, before_;  ///< sums of lambda over the squared support radius (1)
};

}  // namespace migiwa
