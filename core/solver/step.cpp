// A step of position based fluids ([FM] section 4, Macklin & Mueller 2013), from top to bottom:
//
//   position, velocity             what lasts, see FluidState
//      |  predict                  v += g dt, x* = x + v dt, walls keep x* on the fluid side
//      v
//   current = x*
//      |  neighbours               sort along a grid of cells, list the neighbours; thin walls part some
//      |  effects                  on the prediction
//      |  gamma                    for the particles near walls                       ([FM] Eq. 6)
//      v
//   +- lambda                      density, constraint C, lambda                      ([FM] Eqs. 5, 9, 11)
//   |     mean of C within the tolerance, or no iterations left: leave the loop
//   |  position                    x* += dx, over-relaxed by Chebyshev weights        ([FM] Eq. 10)
//   |  effects                     on the positions
//   |  projection, gamma_refresh   walls push x* back to the fluid side; gamma there
//   +- again
//      |  projection               every particle, also those that were far from walls
//      v
//   velocity = (x* - x) / dt, position = x*, then effects on velocities
//
// With the velocity step "projection", and with all solvers but PBF, the velocities do not come from the way
// that the constraint has moved particles, but from a pressure, at the places where the step begins:
//
//   neighbours                     of the positions
//   predict                        v* = the way that walls leave of (v + g dt) dt, over dt
//   effects, gamma                 at the positions
//   pressure                       v = v* - dt grad p / rho, by the solver             (solvers.h)
//   move                           x* = x + v dt, walls keep x* on the fluid side
//   lambda, position, ...          PBF: the loop above; velocities stay
//
// A step that ends with a value that is not finite, or that walls leave no room, is refused and taken back.
#include "core/solver/step.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/solver/parameters.h"
#include "core/solver/solvers.h"
#include "core/solver/state.h"

namespace migiwa::stages {

void predict(StepState& state) {
  Particles& particles = state.particles;
  resizeTight(state.current, particles.size() + 1);
  const float dt = state.timeStep;
  const Vec3f gain = dt * state.gravity;
  parallelFor(state.pool, particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f velocity = particles.velocity[i].xyz() + gain;
      particles.velocity[i].setXyz(velocity);
      state.current[i] = Float4(Vec3f(particles.position[i].xyz() + dt * velocity));
    }
  });
  if (state.softWalls()) pushOutOfSoftWalls(state);
  // Here rather than after the solve: the density must be that of where particles can be.
  projectAll(state);
}

namespace {

/// Sorts through `spare`, which ends up with the values in their old order.
template <class T>
void reorder(std::vector<T>& values, std::vector<T>& spare, const std::vector<std::uint32_t>& order,
             ThreadPool& pool) {
  resizeTight(spare, values.size());
  parallelFor(pool, order.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t k = begin; k < end; ++k) spare[k] = values[order[k]];
  });
  values.swap(spare);
}

}  // namespace

void searchNeighbours(StepState& state) {
  const std::size_t n = state.particles.size();
  state.grid.build(std::span(state.current).first(n), state.supportRadius, state.pool);
  if (state.guards) spreadOverfullCells(state);
  const std::vector<std::uint32_t>& order = state.grid.order();
  reorder(state.current, state.previous, order, state.pool);
  reorder(state.particles.position, state.previous, order, state.pool);
  reorder(state.particles.velocity, state.previous, order, state.pool);
  reorder(state.particles.id, state.spareIds, order, state.pool);
  if (state.projectedPressure.size() == n)
    reorder(state.projectedPressure, state.projection.residual, order, state.pool);
  if (state.wallSlot.size() == n) reorder(state.wallSlot, state.spareIds, order, state.pool);
  // The search has the room of a buffer that the iterations fill only afterwards.
  resizeTight(state.paired, n + NeighbourLists::kScratchExtra);
  state.neighbours.build(state.grid, std::span(state.current).first(n), state.supportRadius, state.paired,
                         state.pool);
  state.current[n] = state.neighbours.ghost();
}

void updateVelocities(StepState& state, bool keep) {
  Particles& particles = state.particles;
  const std::size_t n = particles.size();
  // Written beside instead of over them, which costs no pass of its own.
  std::vector<Float4>& position = keep ? state.before.position : particles.position;
  std::vector<Float4>& velocity = keep ? state.before.velocity : particles.velocity;
  resizeTight(position, n);
  resizeTight(velocity, n);
  const float inverseStep = 1 / state.timeStep;
  parallelFor(state.pool, n, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f solved = state.current[i].xyz();
      const float clearance = knownClearance(state, i, solved);
      velocity[i] = Float4((solved - particles.position[i].xyz()) * inverseStep);
      position[i] = Float4(solved, clearance);
    }
  });
  if (!keep) return;
  particles.position.swap(state.before.position);
  particles.velocity.swap(state.before.velocity);
}

void takeVelocities(StepState& state) {
  Particles& particles = state.particles;
  const float inverseStep = 1 / state.timeStep;
  parallelEach(state.pool, particles.size(), [&](std::size_t i) {
    particles.velocity[i] = Float4(inverseStep * (state.current[i].xyz() - particles.position[i].xyz()));
  });
}

void moveAlong(StepState& state) {
  const Particles& particles = state.particles;
  parallelEach(state.pool, particles.size(), [&](std::size_t i) {
    state.current[i].setXyz(particles.position[i].xyz() + state.timeStep * particles.velocity[i].xyz());
  });
}

void updatePositions(StepState& state) {
  Particles& particles = state.particles;
  const std::size_t n = particles.size();
  std::vector<Float4>& position = state.before.position;
  resizeTight(position, n);
  parallelEach(state.pool, n, [&](std::size_t i) {
    const Vec3f solved = state.current[i].xyz();
    position[i] = Float4(solved, knownClearance(state, i, solved));
  });
  particles.position.swap(position);
}

void acceptPositions(StepState& state) {
  Particles& particles = state.particles;
  for (std::size_t i = 0; i < particles.size(); ++i) particles.position[i] = Float4(state.current[i].xyz());
}

}  // namespace migiwa::stages

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

const Solver& solverOf(const StepState& state) {
  return kSolvers[static_cast<std::size_t>(state.parameters.method)];
}

void listNeighbours(StepState& state) {
  state.times.time("neighbours", [&] { stages::searchNeighbours(state); });
  if (!state.thinWalls.empty()) state.times.time("thin_walls", [&] { stages::separateNeighbours(state); });
}

/// Iterates on the predicted positions until the mean density error is within the tolerance or the iterations
/// are used up. errors[k] is the error after k iterations, so the last one is that of the positions that
/// stay. `watch`, unless it is empty, is called after every stage that may change what the step goes on with.
void solveConstraint(StepState& state, EffectPipeline& effects, int minIterations, const Watch& watch) {
  const SolverParameters& parameters = state.parameters;
  const auto watched = [&](std::string_view stage) {
    if (watch) watch(stage);
  };
  state.errors.clear();
  state.iterations = 0;
  state.pressure.begin(state);
  Chebyshev chebyshev;
  while (true) {
    state.times.time("lambda", [&] { state.errors.push_back(stages::computeLambda(state)); });
    watched("lambda");
    if (state.iterations >= minIterations && state.errors.back().mean <= parameters.tolerance) break;
    if (state.iterations >= parameters.maxIterations) break;
    const bool overRelaxed = parameters.acceleration == Acceleration::chebyshev;
    const float weight = overRelaxed ? chebyshev.next(state.errors, parameters.tolerance) : 1;
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

/// The predicted positions are there: neighbours and gamma of them, and the constraint solved.
void solvePrediction(StepState& state, EffectPipeline& effects, const Watch& watch) {
  listNeighbours(state);
  if (watch) watch("neighbours");
  effects.changePrediction(state, watch);
  state.times.time("gamma", [&] { stages::evaluateGamma(state); });
  if (watch) watch("gamma");
  solveConstraint(state, effects, state.parameters.minIterations, watch);
}

/// The velocities of the step by a pressure, and the positions that they lead to.
void pressAndMove(StepState& state, EffectPipeline& effects, const Watch& watch) {
  const auto watched = [&](std::string_view stage) {
    if (watch) watch(stage);
  };
  state.projectedPressure.resize(state.particles.size(), 0);
  takePositions(state);
  listNeighbours(state);
  if (state.spreadParticles > 0) stages::acceptPositions(state);
  watched("neighbours");
  state.times.time("predict", [&] { stages::predict(state); });
  watched("predict");
  effects.changePrediction(state, watch);
  state.times.time("predict", [&] {
    state.before.velocity = state.particles.velocity;
    stages::takeVelocities(state);
    takePositions(state);
  });
  state.times.time("gamma", [&] { stages::evaluateGamma(state); });
  watched("gamma");
  state.times.time("pressure", [&] {
    state.errors.clear();
    state.iterations = state.pressureIterations = 0;
    solverOf(state).press(state);
  });
  watched("pressure");
  state.times.time("move", [&] { stages::moveAlong(state); });
  // PBF's own have their turn in its iterations.
  if (!state.constrains()) effects.changePositions(state, 1, watch);
  state.times.time("move", [&] {
    stages::projectAll(state);
    stages::takeVelocities(state);
    if (state.gammaMethod != nullptr && !state.boundary.empty()) stages::refreshGamma(state);
  });
  watched("move");
}

/// The part of a step that keeps the particles' own positions. Gravity is in the velocities afterwards.
void predictAndSolve(StepState& state, EffectPipeline& effects, const Watch& watch) {
  state.wallWork.clear();
  state.effectWork = 0;
  if (state.takesPressure()) {
    pressAndMove(state, effects, watch);
    if (!state.constrains()) return;
    // What moves positions alone gives no speed, and so is no work.
    const WallWork work = state.wallWork;
    const double effectWork = state.effectWork;
    // One iteration at least: where errors gather until they pass the tolerance, water at rest is never
    // still.
    solveConstraint(state, effects, 1, watch);
    state.times.time("velocity", [&] { stages::projectAll(state); });
    state.wallWork = work, state.effectWork = effectWork;
  } else {
    state.times.time("predict", [&] { stages::predict(state); });
    if (watch) watch("predict");
    solvePrediction(state, effects, watch);
    state.times.time("velocity", [&] { stages::projectAll(state); });
  }
  if (watch) watch("projection");
}

/// The solved positions, and the velocities that go with them; what was before is kept if `keep`.
void takeSolution(StepState& state, bool keep) {
  if (state.takesPressure()) {
    if (keep && state.constrains()) state.before.pressed = state.particles.velocity;
    stages::updatePositions(state);
  } else {
    stages::updateVelocities(state, keep);
  }
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
  for (const SuppressedPush& jump : state.suppressedPushes)
    began.try_emplace(jump.id, jump.began);  // the first counts
  for (std::size_t i = 0; !began.empty() && i < particles.size(); ++i)
    if (const auto at = began.find(particles.id[i]); at != began.end()) particles.position[i] = at->second;
  state.suppressedPushes.clear();
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

double longestStep(const StepState& state, const EffectPipeline& effects) {
  const double ofEffects = effects.longestStep(state);
  const auto ofSolver = solverOf(state).longestStep;
  return ofSolver != nullptr ? std::min(ofEffects, ofSolver(state)) : ofEffects;
}

StepRefusal advanceStep(StepState& state, EffectPipeline& effects) {
  predictAndSolve(state, effects, {});
  StepRefusal refusal;
  state.times.time("velocity", [&] {
    refusal.notFinite = state.guards && !endsFinite(state);
    if (state.guards && !refusal.notFinite) refusal.overConstrained = findOverConstrained(state);
    if (!refusal.any()) takeSolution(state, state.guards);
  });
  if (!refusal.any()) {
    if (effects.changeVelocities(state, {}) || !state.guards) return refusal;
    refusal.notFinite = true;
    undoUpdate(state);
  } else if (state.takesPressure()) {
    state.particles.velocity.swap(state.before.velocity);
  }
  // What the next step, or one from a save, begins with.
  for (float& pressure : state.projectedPressure)
    if (!std::isfinite(pressure)) pressure = 0;
  undoPrediction(state);
  return refusal;
}

StepFault findFault(StepState& state, EffectPipeline& effects) {
  FaultFinder finder(state);
  finder.begin();
  predictAndSolve(state, effects, [&](std::string_view stage) { finder.after(stage); });
  if (!finder.found()) {
    takeSolution(state, true);
    finder.afterVelocities("velocity");
    effects.changeVelocities(state, [&](std::string_view effect) { finder.afterVelocities(effect); });
    undoUpdate(state);
  } else if (state.takesPressure()) {
    state.particles.velocity.swap(state.before.velocity);
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
  const std::size_t jumps = state.suppressedPushes.size();
  for (int solve = 0; solve < kMostSolves; ++solve) {
    takePositions(state);
    stages::projectAll(state);
    solvePrediction(state, none, {});
    stages::projectAll(state);
    stages::acceptPositions(state);
    // With the neighbours of where particles are now: those of the solve are not, after a long way.
    prepareFields(state);
    if (state.errors.back().max <= kCalm) break;
  }
  state.parameters.positionStep = form;
  state.suppressedPushes.resize(jumps);
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
