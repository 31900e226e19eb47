// What the solvers share that find a pressure p_i and push by it: the passes over pairs.
//
// METHOD: docs/method.md, "Other solvers". All pushes come from the energy of the corrected density
// s_i = rho_i/rho0 = S_i / g_i, g_i being what StepState::densityGamma() makes of gamma. With
// e'(rho) = p / rho^2 the variation of the energy sum_i m e(rho_i) is the acceleration
//
//   a_i = -(m/rho0) sum_j (w_i + w_j) grad W_ij + w_i s_i grad g_i,    w_i = p_i / (rho0 s_i^2 g_i)
//
// Its first sum is antisymmetric in the pairs, so it conserves momentum; the second term is what the wall
// gives, and -m times it what the wall gets. Where a method adds the density of the wall, s = S + 1 - g, it
// is w_i = p_i / (rho0 s_i^2), and w_i grad g_i.
#pragma once

#include "core/solver/state.h"

namespace migiwa::press {

/// Density at state.current; sum_k |grad_k s_i|^2 (1/m^2) into projection.diagonal; factors F of the pairs,
/// (m/rho0) grad W_ij = F_ij (x_i - x_j), which stay with the neighbour lists. Makes ready for push().
/// Returns the density error.
IterationError measure(StepState& state);

/// projection.velocity: the particles' velocities and what the pressures state.projectedPressure change of
/// them in a step. `viscosity` (m^2/s) is that of Monaghan's artificial one, alpha c l, l half the support.
void push(StepState& state, float viscosity = 0);

/// Density where the particles would be that start at their positions with projection.velocity, with gamma
/// there, into state.density. Returns its error.
IterationError predictDensity(StepState& state);

/// d s_i / dt of projection.velocity, at the places of measure(), into projection.residual (1/s).
void rate(StepState& state);

/// The pressure over rho0 (m^2/s^2) for a density error of 1: half of what would undo it in a step where the
/// neighbourhood is full, for neighbours push, too; less where there are few. `squares`: sum_k |grad_k s|^2.
float stiffness(const StepState& state, float squares);

/// Adds to state.wallWork the work of moving walls in the push by state.projectedPressure, of density and
/// gamma as they were in it: predictDensity() changes both.
void bookWork(StepState& state);

/// The step goes on with what push() has found.
void take(StepState& state);

}  // namespace migiwa::press
