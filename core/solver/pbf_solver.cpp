#include "core/solver/pbf_solver.h"

#include <algorithm>

#include "core/solver/acceleration.h"
#include "core/solver/stages.h"
#include "core/solver/thin_walls.h"

namespace migiwa {

namespace {

/// Predicts that every particle stays where it is.
void takePositions(StepState& state) {
  const std::vector<Float4>& position = state.particles.position;
  resizeTight(state.current, position.size() + 1);
  std::copy(position.begin(), position.end(), state.current.begin());
}

/// Iterates on the predicted positions until the mean density error is within the tolerance or the iterations
/// are used up. errors[k] is the error after k iterations, so the last one is that of the positions that
/// stay.
void solveConstraint(StepState& state, EffectPipeline& effects) {
  const SolverParameters& parameters = state.parameters;
  state.times.time("neighbours", [&] { stages::searchNeighbours(state); });
  if (!state.thinWalls.empty()) state.times.time("thin_walls", [&] { stages::separateNeighbours(state); });
  effects.changePrediction(state);
  state.times.time("gamma", [&] { stages::evaluateGamma(state); });
  state.errors.clear();
  state.iterations = 0;
  Chebyshev chebyshev;
  while (true) {
    state.times.time("lambda", [&] { state.errors.push_back(stages::computeLambda(state)); });
    if (state.iterations >= parameters.minIterations && state.errors.back().mean <= parameters.tolerance)
      break;
    if (state.iterations >= parameters.maxIterations) break;
    const bool stretch = parameters.acceleration == Acceleration::chebyshev;
    const float weight = stretch ? chebyshev.next(state.errors, parameters.tolerance) : 1;
    state.times.time("position", [&] { stages::movePositions(state, weight); });
    effects.changePositions(state, weight);
    if (!state.boundary.empty()) {
      state.times.time("projection", [&] { stages::projectNearWalls(state); });
      if (state.gammaMethod != nullptr)
        state.times.time("gamma_refresh", [&] { stages::refreshGamma(state); });
    }
    ++state.iterations;
  }
}

}  // namespace

void advanceStep(StepState& state, EffectPipeline& effects) {
  state.times.time("predict", [&] { stages::predict(state); });
  solveConstraint(state, effects);
  state.times.time("velocity", [&] {
    stages::projectAll(state);
    stages::updateVelocities(state);
  });
  effects.changeVelocities(state);
}

void relax(StepState& state) {
  // The mean hides the few that were pushed: what counts here is the largest error, and a wall's first layer
  // of a resting lattice reads some percent by itself. Neighbours change on the way, hence several solves.
  constexpr double kCalm = 0.04;
  constexpr int kMostSolves = 30;
  EffectPipeline none;
  for (int solve = 0; solve < kMostSolves; ++solve) {
    takePositions(state);
    stages::projectAll(state);
    solveConstraint(state, none);
    stages::projectAll(state);
    stages::acceptPositions(state);
    if (state.errors.back().max <= kCalm) break;
  }
}

long stabilise(StepState& state) {
  Particles& particles = state.particles;
  // Rounding leaves centres a hair nearer than the margin; that is no start inside a wall.
  const float allowed = 1e-3F * state.spacing;
  const long inside = parallelReduce(
      state.pool, particles.size(), 0L,
      [&](std::size_t begin, std::size_t end) {
        long count = 0;
        for (std::size_t i = begin; i < end; ++i) {
          Vec3f p = particles.position[i].xyz();
          if (state.boundary.project(p, state.wallMargin()) &&
              (p - particles.position[i].xyz()).norm() > allowed)
            ++count;
        }
        return count;
      },
      [](long a, long b) { return a + b; });
  if (inside == 0) return 0;
  relax(state);
  return inside;
}

void prepareFields(StepState& state) {
  takePositions(state);
  stages::searchNeighbours(state);
  if (!state.thinWalls.empty()) stages::separateNeighbours(state);
  stages::evaluateGamma(state);
  state.errors = {stages::computeLambda(state)};
}

}  // namespace migiwa
