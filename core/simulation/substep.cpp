// A frame of a simulation: its substeps, and what each of them does around the step of the solver.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "core/simulation/run_state.h"
#include "core/solver/solvers.h"

namespace migiwa {

namespace {

/// Substeps a frame has at most: a run that needs more is told so instead of standing still.
constexpr long kMostSubsteps = 1000;

}  // namespace

void Simulation::State::describeFrame() {
  info.time = time;
  info.steps = statistics.steps;
  info.iterations = step.iterations;
  info.errors = statistics.steps > 0 ? step.errors : std::vector<IterationError>();
  info.stateHash = hash();
  info.energy = statistics.energy.history;
  step.pressure.pressures(step, pressure);
}

void Simulation::State::sumPressures(double dt) {
  if (!gauges.readsPressure()) return;
  step.pressure.pressures(step, pressure);
  const GaugedFluid fluid{step.particles.position, step.particles.velocity, pressure};
  for (std::size_t k = 0; k < gauges.size(); ++k)
    if (gauges.isPressure(k))
      pressureSums[k] +=
          dt * gauges.read(k, fluid, nullptr, scene.solver.kernel, static_cast<double>(step.supportRadius))
                   .value_or(0);
}

void Simulation::State::readGauges() {
  const GaugedFluid fluid{step.particles.position, step.particles.velocity, pressure};
  for (std::size_t k = 0; k < gauges.size(); ++k) {
    std::optional<double> value;
    if (!gauges.isPressure(k))
      value = gauges.read(k, fluid, gamma.method.get(), scene.solver.kernel,
                          static_cast<double>(step.supportRadius));
    else if (frame > 0)
      value = pressureSums[k] / scene.solver.timeStep;
    if (value) statistics.gauges[k].add(time, *value);
  }
  describeGauges();
}

void Simulation::State::describeGauges() {
  info.gauges.clear();
  for (std::size_t k = 0; k < statistics.gauges.size(); ++k)
    info.gauges.push_back(
        {scene.gauges[k].name, std::string(scene.gauges[k].unit()), statistics.gauges[k].few()});
}

/// Walls are where they end up, having been at their places of `before`.
void Simulation::State::moveWalls(double before, double now) {
  boundary.moveTo(before, now);
  drawnWalls.reset();
  if (gamma.method) gamma.method->wallsMoved();
  wallsGave = std::max(wallsGave, wallSpeed(before, now));
  limits.given = std::max(limits.given, wallsGave);
  // What goes along with the walls does not leave.
  if (!limits.domainGrows) return;
  for (const auto& wall : boundary.moving()) limits.domain.include(wall->bounds());
}

/// The largest speed (m/s) of a place on a wall between two times (s).
double Simulation::State::wallSpeed(double from, double to) const {
  double speed = 0;
  for (const auto& moving : boundary.moving()) {
    const Bounds own = moving->rest()->bounds();
    speed =
        std::max(speed, migiwa::largestSpeed(moving->motion(), own.empty() ? scene.bounds() : own, from, to));
  }
  return speed;
}

/// How fast (m/s) particles and walls may come towards each other between `start` and `start + span` (s).
double Simulation::State::largestSpeed(double start, double span) const {
  const double fluid = static_cast<double>(health.maxSpeed) + scene.gravity.norm() * span;
  return std::max(fluid, emission.largestSpeed(start, start + span)) + wallSpeed(start, start + span);
}

/// Returns the sums of what has come in.
EnergySums Simulation::State::emit(double start) {
  const std::size_t first = step.particles.size();
  emission.emit(start, step, statistics);
  const EnergySums given = energySums(step.particles, first, limits.centre);
  statistics.energy.emitters += given.kinetic + given.potential(scene.gravity);
  return given;
}

/// Returns the sums of what is taken out.
EnergySums Simulation::State::removeOutflow(double start) {
  return outflow.remove(start, limits.domain, limits.centre, step, statistics);
}

/// A next step would undo what this one has left in one go, the faster the shorter it is: then the CFL rule
/// makes the steps shorter still, and energy grows without bound. Velocities, and so momentum, stay.
void Simulation::State::partCrowded() {
  statistics.note("crowded", statistics.steps + 1,
                  "a step left density " + std::to_string(1 + step.errors.back().max) +
                      " of that at rest; particles were moved apart without gaining speed");
  const std::vector<IterationError> errors = step.errors;
  const int iterations = step.iterations;
  relax(step);
  step.errors = errors, step.iterations = iterations;
}

/// Energy never grows without a source, see holdEnergy().
void Simulation::State::takeBackExcess(const EnergySums& before, double dt) {
  // Velocities are differences of positions, which are rounded: the more, the farther from the origin they
  // are.
  const double farthest = std::max(limits.farthest, static_cast<double>(health.farthest));
  const double rounding = 0x1p-24 * farthest / dt * static_cast<double>(health.maxSpeed);
  const double excess = statistics.energy.excess(step, before, health.energy, dt, rounding);
  if (excess <= 0) return;
  const auto count = static_cast<double>(health.energy.particles);
  if (const HeldEnergy held = holdEnergy(step, effects, excess); held.particles > 0) {
    statistics.note("energy_held", statistics.steps + 1,
                    "a step would have added " + std::to_string(excess / count) + " J/kg from nothing; " +
                        std::to_string(held.taken / count) + " were taken back from " +
                        std::to_string(held.particles) + " of " + std::to_string(health.energy.particles) +
                        " particles, where they were gained");
    health = inspect(step, limits);
  }
  if (const double left = statistics.energy.excess(step, before, health.energy, dt, rounding); left > 0) {
    statistics.note("energy_gained", statistics.steps + 1,
                    "a step has added " + std::to_string(left / count) +
                        " J/kg from nothing, which could not be taken back");
  }
}

/// The state stays the last good one, and the simulation stops there.
void Simulation::State::refuseNotFinite() {
  const StepFault fault = findFault(step, effects);
  std::string neighbours;
  constexpr std::size_t kNamed = 8;
  for (std::size_t k = 0; k < std::min(fault.neighbours.size(), kNamed); ++k)
    neighbours += (k > 0 ? ", " : "") + std::to_string(fault.neighbours[k]);
  if (fault.neighbours.size() > kNamed) neighbours += ", ...";
  statistics.nonfiniteParticles = std::max(1L, fault.particles);
  statistics.note("nonfinite", statistics.steps + 1,
                  std::to_string(fault.particles) + " particles are not finite after the stage \"" +
                      fault.stage + "\", particle " + std::to_string(fault.particle) +
                      " among them, whose neighbours are " + (neighbours.empty() ? "none" : neighbours) +
                      "; the step was not taken");
}

/// The same where walls leave no room: they go back, too.
void Simulation::State::refuseOverConstrained(const OverConstrained& overConstrained, double start) {
  const Vec3d place = scene.origin + overConstrained.place.cast<double>();
  std::ostringstream where;
  if (!scene.origin.isZero(0)) where.precision(10);
  where << "(" << place.x() << ", " << place.y() << ", " << place.z() << ") m";
  std::ostringstream detail;
  detail << "walls leave the fluid less room than it needs: however long it is solved for, its density stays "
         << 1 + overConstrained.largest << " of that at rest at " << where.str() << ", and "
         << 1 + overConstrained.mean << " in the mean of all, after " << start
         << " s; the step was not taken. Let the fluid out, stop the moving wall earlier, or start "
         << "or emit less fluid";
  statistics.overConstrained = true;
  statistics.note("squeezed", statistics.steps + 1, detail.str());
  if (boundary.moves()) moveWalls(start, start);
  prepareFields(step);
}

void Simulation::State::advanceSubstep(double start, double dt) {
  const auto began = std::chrono::steady_clock::now();
  step.timeStep = static_cast<float>(dt);
  static_cast<StepRecord&>(step).clear();
  savedNeighbours.clear();
  if (boundary.moves()) step.times.time("move_walls", [&] { moveWalls(start, start + dt); });
  EnergySums before = health.energy;
  if (health.outside > 0 || outflow.anyOpen(start))
    step.times.time("outflow", [&] { before -= removeOutflow(start); });
  statistics.energy.beginStep(step, before.particles, dt, statistics.steps == 0);
  if (!emission.empty()) step.times.time("emitters", [&] { before += emit(start); });
  const StepRefusal refusal = advanceStep(step, effects);
  stepTaken = !refusal.any();
  if (refusal.notFinite) return refuseNotFinite();
  if (refusal.overConstrained.found) return refuseOverConstrained(refusal.overConstrained, start);
  step.times.time("check", [&] {
    health = inspect(step, limits);
    if (step.guards) takeBackExcess(before, dt);
  });
  if (step.guards && step.errors.back().max > kCrowded) {
    step.times.time("relax", [&] { partCrowded(); });
    health = inspect(step, limits);
  }
  step.times.time("check", [&] { statistics.energy.record(step, before, health.energy, dt, start + dt); });
  statistics.fluid.sample(start + dt);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  statistics.record(step, health, dt, seconds);
}

void Simulation::advanceFrame() {
  State& state = *state_;
  if (stopped()) return;
  const SolverParameters& parameters = state.scene.solver;
  const double frameStep = parameters.timeStep;
  const double longest = frameStep / parameters.substeps;
  const double reach = parameters.cfl * static_cast<double>(state.step.supportRadius);

  state.pressureSums.assign(state.gauges.size(), 0);
  StageTimes frameTimes;
  double wallSeconds = 0;
  double left = frameStep;
  long taken = 0;
  while (left > 1e-9 * frameStep && !stopped()) {
    const double start = state.time + (frameStep - left);
    double step = longest;
    if (parameters.cfl > 0) {
      const double speed = state.largestSpeed(start, longest);
      if (speed * step > reach) step = reach / speed;
      step = std::min(step, migiwa::longestStep(state.step, state.effects));
    } else if (const auto ofSolver = kSolvers[static_cast<std::size_t>(parameters.method)].longestStep) {
      step = std::min(step, ofSolver(state.step));
    }
    // In doubles: a step that the CFL rule makes short enough has more parts than a whole number holds.
    const double wanted = std::ceil(left / step - 1e-6), most = static_cast<double>(kMostSubsteps - taken);
    double parts = std::max(wanted, 1.0);
    if (!(wanted <= most)) {
      state.statistics.note("cfl_not_met", state.statistics.steps,
                            std::string("the fastest particle") +
                                (parameters.method == SolverMethod::wcsph ? ", or sound," : "") +
                                " would need more than " + std::to_string(kMostSubsteps) +
                                " substeps a frame; a smaller time_step helps");
      parts = std::max(most, 1.0);
    }
    const double dt = left / parts;
    state.advanceSubstep(start, dt);
    if (!state.stepTaken) {
      // What is left is the state of the last good step, which may be within the frame.
      state.time = start;
      state.describeFrame();
      return;
    }
    state.sumPressures(dt);
    left -= dt;
    ++taken;
    frameTimes.add(state.step.times);
    wallSeconds += static_cast<double>(state.statistics.stepSeconds.back());
  }
  ++state.frame;
  state.time += frameStep;
  state.statistics.simulatedSeconds = state.time;
  state.info.stages = frameTimes;
  state.info.stepSeconds = wallSeconds / static_cast<double>(std::max(taken, 1L));
  state.describeFrame();
  state.readGauges();
}

}  // namespace migiwa
