// Predictive-corrective incompressible SPH, METHOD: Solenthaler & Pajarola 2009. Pressures grow by the
// density that they lead to until that is within the tolerance, at least three times:
//
//   x* = x + dt (v* + dt a(p)),    p_i += delta_i (rho*_i - rho0),  p >= 0
//
// Neighbours and gradients are those of x, distances and gamma those of x*. Deviations: delta_i is each
// particle's own, with its gamma, where the paper has that of a filled neighbourhood for all; there the two
// are the same (press::stiffness). The tolerance is of the mean error, as for the other solvers. As in the
// paper, each step's pressures begin at zero: with those of the step before, water at rest trembles more.
#include <algorithm>

#include "core/solver/press.h"
#include "core/solver/solvers.h"

namespace migiwa {

void stages::pressByPrediction(StepState& state) {
  const SolverParameters& parameters = state.parameters;
  press::measure(state);
  const WallWork before = state.wallWork;
  std::fill(state.projectedPressure.begin(), state.projectedPressure.end(), 0.0F);
  while (true) {
    state.errors.push_back(press::predictDensity(state));
    if (state.iterations >= parameters.minIterations && state.errors.back().mean <= parameters.tolerance)
      break;
    if (state.iterations >= parameters.maxIterations) break;
    parallelEach(state.pool, state.particles.size(), [&](std::size_t i) {
      const float change = press::stiffness(state, state.projection.diagonal[i]) * (state.density[i] - 1);
      state.projectedPressure[i] = std::max(state.projectedPressure[i] + change, 0.0F);
    });
    press::push(state);
    state.wallWork = before;
    press::bookWork(state);
    ++state.iterations;
  }
  press::take(state);
}

}  // namespace migiwa
