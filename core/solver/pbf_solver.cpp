#include "core/solver/pbf_solver.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/base/guard.h"
#include "core/solver/acceleration.h"
#include "core/solver/stages.h"
#include "core/solver/thin_walls.h"

namespace migiwa {

namespace {

using Watch = EffectPipeline::Watch;

/// Whether the places where the step ends are all finite. One that is not makes the sum so.
bool endsFinite(const StepState& state) {
  const float sum = parallelReduce(
      state.pool, state.particles.size(), 0.0F,
      [&](std::size_t begin, std::size_t end) {
        // What is finite times zero is zero, so that no sum of large coordinates overflows.
        // Three sums, so that none waits for another.
        Vec3f part = Vec3f::Zero();
        for (std::size_t i = begin; i < end; ++i) part += 0 * state.current[i].xyz();
        return part.sum();
      },
      [](float a, float b) { return a + b; });
  return sum == 0;
}

/// Predicts that every particle stays where it is.
void takePositions(StepState& state) {
  const std::vector<Float4>& position = state.particles.position;
  resizeTight(state.current, position.size() + 1);
  std::copy(position.begin(), position.end(), state.current.begin());
}

/// Iterates on the predicted positions until the mean density error is within the tolerance or the iterations
/// are used up. errors[k] is the error after k iterations, so the last one is that of the positions that
/// stay. `watch`, unless it is empty, is called after every stage that may change what the step goes on with.
void solveConstraint(StepState& state, EffectPipeline& effects, const Watch& watch) {
  const SolverParameters& parameters = state.parameters;
  const auto watched = [&](std::string_view stage) {
    if (watch) watch(stage);
  };
  state.times.time("neighbours", [&] { stages::searchNeighbours(state); });
  if (!state.thinWalls.empty()) state.times.time("thin_walls", [&] { stages::separateNeighbours(state); });
  watched("neighbours");
  effects.changePrediction(state, watch);
  state.times.time("gamma", [&] { stages::evaluateGamma(state); });
  watched("gamma");
  state.errors.clear();
  state.iterations = 0;
  state.pressure.begin(state);
  Chebyshev chebyshev;
  while (true) {
    state.times.time("lambda", [&] { state.errors.push_back(stages::computeLambda(state)); });
    watched("lambda");
    if (state.iterations >= parameters.minIterations && state.errors.back().mean <= parameters.tolerance)
      break;
    if (state.iterations >= parameters.maxIterations) break;
    const bool stretch = parameters.acceleration == Acceleration::chebyshev;
    const float weight = stretch ? chebyshev.next(state.errors, parameters.tolerance) : 1;
    state.times.time("position", [&] {
      stages::movePositions(state, weight);
      if (state.boundary.moves()) state.wallWork.iterate(wallPush(state), weight);
      state.pressure.iterate(state, weight);
    });
    watched("position");
    effects.changePositions(state, weight, watch);
    if (!state.boundary.empty()) {
      state.times.time("projection", [&] { stages::projectNearWalls(state); });
      if (state.gammaMethod != nullptr)
        state.times.time("gamma_refresh", [&] { stages::refreshGamma(state); });
      watched("projection");
    }
    ++state.iterations;
  }
}

}  // namespace

namespace {

/// The part of a step that keeps the particles' own positions. Gravity is in the velocities afterwards.
void predictAndSolve(StepState& state, EffectPipeline& effects, const Watch& watch) {
  state.wallWork.clear();
  state.effectWork = 0;
  state.times.time("predict", [&] { stages::predict(state); });
  if (watch) watch("predict");
  solveConstraint(state, effects, watch);
  state.times.time("velocity", [&] { stages::projectAll(state); });
  if (watch) watch("projection");
}

/// Takes back velocities and positions that stages::updateVelocities has kept.
void undoUpdate(StepState& state) {
  state.particles.position.swap(state.before.position);
  state.particles.velocity.swap(state.before.velocity);
}

/// Takes back what predict() has added, and what the projection has moved of starts.
void undoPrediction(StepState& state) {
  Particles& particles = state.particles;
  const Vec3f gain = state.timeStep * state.gravity;
  for (Float4& velocity : particles.velocity) velocity.setXyz(velocity.xyz() - gain);
  std::unordered_map<std::uint32_t, Float4> began;
  for (const WithheldJump& jump : state.wallJumps)
    began.try_emplace(jump.id, jump.began);  // the first counts
  for (std::size_t i = 0; !began.empty() && i < particles.size(); ++i)
    if (const auto at = began.find(particles.id[i]); at != began.end()) particles.position[i] = at->second;
  state.wallJumps.clear();
}

/// Looks through the state after each stage, and keeps what it finds first.
class FaultFinder {
 public:
  explicit FaultFinder(const StepState& state) : state_(state) {}

  void begin() {
    const Particles& particles = state_.particles;
    take("before the step", [&](std::size_t i) {
      return particles.position[i].xyz().allFinite() && particles.velocity[i].xyz().allFinite();
    });
  }
  void after(std::string_view stage) {
    const auto ofLength = [&](const std::vector<float>& values, std::size_t i) {
      return values.size() != state_.particles.size() || std::isfinite(values[i]);
    };
    const bool solved = stage == "lambda", corrected = stage == "gamma" || stage == "projection";
    take(stage, [&](std::size_t i) {
      return state_.current[i].xyz().allFinite() &&
             (!solved || (ofLength(state_.density, i) && ofLength(state_.lambda, i))) &&
             (!corrected || ofLength(state_.gamma, i));
    });
  }
  void afterVelocities(std::string_view stage) {
    take(stage,
         [&](std::size_t i) { return std::isfinite(state_.particles.velocity[i].xyz().squaredNorm()); });
  }
  bool found() const { return found_.particles > 0; }
  StepFault result() const { return found_; }

 private:
  template <class Fine>
  void take(std::string_view stage, const Fine& fine) {
    if (found_.particles > 0) return;
    for (std::size_t i = 0; i < state_.particles.size(); ++i) {
      if (fine(i)) continue;
      if (found_.particles++ > 0) continue;
      found_.stage = stage;
      found_.particle = state_.particles.id[i];
      if (state_.neighbours.counts().size() == state_.particles.size())
        for (const std::uint32_t j : state_.neighbours.of(i))
          found_.neighbours.push_back(state_.particles.id[j]);
    }
  }

  const StepState& state_;
  StepFault found_;
};

}  // namespace

StepRefusal advanceStep(StepState& state, EffectPipeline& effects) {
  predictAndSolve(state, effects, {});
  StepRefusal refusal;
  state.times.time("velocity", [&] {
    refusal.notFinite = kGuards && !endsFinite(state);
    if (kGuards && !refusal.notFinite) refusal.squeeze = findSqueeze(state);
    if (!refusal.any()) stages::updateVelocities(state, kGuards);
  });
  if (!refusal.any()) {
    if (effects.changeVelocities(state, {}) || !kGuards) return refusal;
    refusal.notFinite = true;
    undoUpdate(state);
  }
  undoPrediction(state);
  return refusal;
}

StepFault findFault(StepState& state, EffectPipeline& effects) {
  FaultFinder finder(state);
  finder.begin();
  predictAndSolve(state, effects, [&](std::string_view stage) { finder.after(stage); });
  if (!finder.found()) {
    stages::updateVelocities(state, true);
    finder.afterVelocities("velocity");
    effects.changeVelocities(state, [&](std::string_view effect) { finder.afterVelocities(effect); });
    undoUpdate(state);
  }
  undoPrediction(state);
  return finder.result();
}

void relax(StepState& state) {
  // The mean hides the few that were pushed: what counts here is the largest error, and a wall's first layer
  // of a resting lattice reads some percent by itself. Neighbours change on the way, hence several solves.
  constexpr double kCalm = 0.04;
  constexpr int kMostSolves = 30;
  EffectPipeline none;
  // Where the step is to go by another form, this is no step: only the true gradient gets fluid out of walls.
  const PositionStep form = std::exchange(state.parameters.positionStep, PositionStep::gradient);
  // Nothing here gains speed anyway.
  const std::size_t jumps = state.wallJumps.size();
  for (int solve = 0; solve < kMostSolves; ++solve) {
    takePositions(state);
    stages::projectAll(state);
    solveConstraint(state, none, {});
    stages::projectAll(state);
    stages::acceptPositions(state);
    // With the neighbours of where particles are now: those of the solve are not, after a long way.
    prepareFields(state);
    if (state.errors.back().max <= kCalm) break;
  }
  state.parameters.positionStep = form;
  state.wallJumps.resize(jumps);
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
