// Divergence-free SPH, METHOD: Bender & Koschier 2015. Two solves a step, at the places where it begins. The
// first takes the divergence out of the velocities that the step before has left, the second keeps the
// density that gravity and the rest would lead to:
//
//   d s_i / dt = 0 after the first,    s_i + dt d s_i / dt = 1 after the second,    p >= 0
//
// Both push by pressures that grow by what is left, p_i += (what is left) / (dt^2 alpha_i'), alpha' being
// the sum of squared gradients of the density (press::stiffness). Deviations: pressures are summed up and
// kept from below zero, where the paper corrects velocities by each iteration's alone; what has less than 0.9
// of its density feels no divergence, where the paper counts neighbours, of which there are fewer beside
// walls. The second solve begins with half the pressures of the step before (warm start; with all of them
// water at rest trembles more), the first with none. The tolerances are of the mean errors.
#include <algorithm>

#include "core/solver/press.h"
#include "core/solver/solvers.h"

namespace migiwa {

namespace {

/// Of the pressures of the step before, where the second solve begins.
constexpr float kWarm = 0.5F;
/// Below it a particle is at the surface, or flies.
constexpr float kInside = 0.9F;

struct Solved {
  int iterations;
  double left;  ///< the mean error
};

/// Lets pressures grow until the mean of error(i) > 0 is at most `tolerance`.
/// `error`: of the density that is left (1), from the rate in projection.residual.
template <class Error>
Solved solve(StepState& state, int least, int most, double tolerance, const Error& error) {
  const auto count = static_cast<double>(std::max<std::size_t>(state.particles.size(), 1));
  press::push(state);
  for (int iterations = 0;; ++iterations) {
    press::rate(state);
    const double left = parallelSum(state.pool, state.particles.size(), [&](std::size_t i) {
      return static_cast<double>(std::max(error(i), 0.0F));
    });
    if ((iterations >= least && left <= tolerance * count) || iterations >= most)
      return {iterations, left / count};
    parallelEach(state.pool, state.particles.size(), [&](std::size_t i) {
      const float s = state.density[i], change = press::stiffness(state, state.projection.diagonal[i]);
      state.projectedPressure[i] = std::max(state.projectedPressure[i] + s * s * change * error(i), 0.0F);
    });
    press::push(state);
  }
}

}  // namespace

void stages::pressFreeOfDivergence(StepState& state) {
  const SolverParameters& parameters = state.parameters;
  const std::size_t n = state.particles.size();
  state.errors.push_back(press::measure(state));
  ProjectionBuffers& buffers = state.projection;
  // The first solve is of the velocities that the step before has left, before gravity and before walls have
  // taken off what gravity alone would press into them.
  const Vec3f gain = state.timeStep * state.gravity;
  const std::vector<Float4>& began = state.before.velocity;
  buffers.potential.resize(n);
  parallelEach(state.pool, n, [&](std::size_t i) {
    state.previous[i] = Float4(Vec3f(began[i].xyz() - gain));
    buffers.potential[i] = kWarm * state.projectedPressure[i];
    state.projectedPressure[i] = 0;
  });
  const Solved divergence =
      solve(state, 1, parameters.maxPressureIterations, parameters.divergenceTolerance, [&](std::size_t i) {
        return state.density[i] < kInside ? 0.0F : state.timeStep * buffers.residual[i];
      });
  parallelEach(state.pool, n, [&](std::size_t i) {
    const Vec3f change = buffers.velocity[i].xyz() - state.previous[i].xyz();
    state.previous[i] = Float4(Vec3f(state.particles.velocity[i].xyz() + change));
    std::swap(buffers.potential[i], state.projectedPressure[i]);
  });
  const Solved density =
      solve(state, parameters.minIterations, parameters.maxIterations, parameters.tolerance,
            [&](std::size_t i) { return state.density[i] - 1 + state.timeStep * buffers.residual[i]; });
  state.pressureIterations = divergence.iterations, state.divergenceLeft = divergence.left;
  state.iterations = density.iterations, state.densityLeft = density.left;
  // What walls and wall friction see is the push of both.
  parallelEach(state.pool, n, [&](std::size_t i) { state.projectedPressure[i] += buffers.potential[i]; });
  press::bookWork(state);
  press::take(state);
}

}  // namespace migiwa
