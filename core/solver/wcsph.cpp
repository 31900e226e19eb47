// Weakly compressible SPH, METHOD: Becker & Teschner 2007. The pressure follows from the density by Tait's
// equation,
//
//   p = B ((rho/rho0)^7 - 1), p >= 0,    B = rho0 c^2 / 7,
//
// and the speed of sound c is so large that water compresses by no more than is asked for: c = v / sqrt(eta)
// at a compression eta and the largest speed v of the flow. Artificial viscosity of Monaghan 1992 keeps the
// sound from growing. Deviations: the push is the variation of the energy of the density that gamma corrects
// (press.h), pressures below zero are left out, and viscosity has the density at rest in its denominator, so
// that its pairs are antisymmetric.
//
// The step is symplectic Euler, whose velocities are those of a leapfrog. Sound may cross 0.4 support radii
// in a step, twice what their rule allows, whose length is half the support; 0.6 are still stable.
#include <algorithm>

#include "core/solver/press.h"
#include "core/solver/solvers.h"

namespace migiwa {

void stages::pressByDensity(StepState& state) {
  state.errors.push_back(press::measure(state));
  const float stiffness = state.soundSpeed * state.soundSpeed / 7;
  parallelEach(state.pool, state.particles.size(), [&](std::size_t i) {
    const float s = state.density[i], s3 = s * s * s;
    state.projectedPressure[i] = stiffness * std::max(s3 * s3 * s - 1, 0.0F);
  });
  const auto alpha = static_cast<float>(state.parameters.wcsph.viscosity);
  press::push(state, alpha * state.soundSpeed * 0.5F * state.supportRadius);
  press::bookWork(state);
  press::take(state);
}

double soundStep(const StepState& state) {
  constexpr double kCourant = 0.4;
  return kCourant * static_cast<double>(state.supportRadius) / static_cast<double>(state.soundSpeed);
}

}  // namespace migiwa
