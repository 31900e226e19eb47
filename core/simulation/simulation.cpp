#include "core/simulation/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/scene.h"
#include "core/simulation/fill.h"
#include "core/simulation/state.h"
#include "core/simulation/statistics.h"
#include "core/solver/parameters.h"
#include "core/solver/step.h"
#include "core/walls/boundary.h"
#include "core/walls/gridded.h"

namespace migiwa {

namespace {

Boundary wallsOf(const Scene& scene, ThreadPool& pool) {
  return Boundary(withDistanceGrids(scene.surfaces, static_cast<float>(scene.supportRadius()), pool,
                                    scene.file.string() + ":/boundary/surfaces"));
}

}  // namespace

struct Simulation::State {
  State(Scene theScene, int threads, Guards guards)
      : scene(std::move(theScene)),
        pool(threads),
        boundary(wallsOf(scene, pool)),
        step(pool, boundary),
        emission(scene, boundary) {
    step.guards = guards == Guards::on;
  }

  /// Takes settings over wholly, or throws and stays as it is.
  void configure(const Settings& settings);
  void advanceSubstep(double start, double dt);
  EnergySums emit(double start);
  void partCrowded();
  void takeBackExcess(const EnergySums& before, double dt);
  void refuseNotFinite();
  void refuseOverConstrained(const OverConstrained& overConstrained, double start);
  void moveWalls(double before, double now);
  double largestSpeed(double start, double span) const;
  std::uint64_t hash() {
    return migiwa::stateHash(step.particles.id, step.particles.position, step.particles.velocity, pool);
  }
  /// What a picture says of the frame, but for wall times.
  void describeFrame();

  Scene scene;
  ThreadPool pool;
  Boundary boundary;
  StepState step;
  Emission emission;
  PickedGamma gamma;
  EffectPipeline effects;
  RunStatistics statistics;
  Health health;
  HealthLimits limits;
  FrameInfo info;
  std::shared_ptr<const WallDrawing> drawnWalls;  ///< as they are now; null: nobody has asked
  std::vector<std::uint32_t> savedNeighbours;     ///< counts that came with a save, until the next step
  bool stepTaken = true;                          ///< false: the last step was refused
  std::vector<float> pressure;                    ///< (Pa) of the last step; empty: nobody watches
  long frame = 0;
  double time = 0;
};

namespace {

/// Of the fluid along gravity (m); 0 without either.
double heightOf(const StepState& state) {
  const float strength = state.gravity.norm();
  if (strength <= 0 || state.particles.size() == 0) return 0;
  float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
  for (const Float4& position : state.particles.position) {
    const float height = -state.gravity.dot(position.xyz()) / strength;
    lowest = std::min(lowest, height), highest = std::max(highest, height);
  }
  return static_cast<double>(highest - lowest);
}

/// Substeps a frame has at most: a run that needs more is told so instead of standing still.
constexpr long kMostSubsteps = 1000;

}  // namespace

/// Whatever may fail is made first, beside what is in force.
void Simulation::State::configure(const Settings& settings) {
  requireSteppable(settings.boundary, scene.file);
  Scene changed = scene;
  changed.solver = settings.solver;
  changed.boundary = settings.boundary;
  changed.effects = settings.effects;
  const auto supportRadius = static_cast<float>(changed.supportRadius());
  WallExchange walls(boundary);  // a gamma method refers to the walls where they will be
  if (step.supportRadius > 0 && supportRadius != step.supportRadius) {
    walls.put(wallsOf(changed, pool));
    boundary.moveTo(time, time);
  }
  std::vector<const Surface*> thin = migiwa::thinWalls(boundary, supportRadius), barring;
  if (step.guards) barring = migiwa::collisionWalls(boundary, supportRadius);
  const RestingLattice lattice = restingLattice(changed.solver.kernel, changed.solver.supportRatio);
  PickedGamma picked;
  std::string handlingName = "no correction", gammaName;
  if (!boundary.empty()) {
    const BoundaryHandling handling = changed.boundary.handling;
    const bool isGamma = handling == BoundaryHandling::gamma;
    picked =
        makeHandling(handling, changed.boundary.gammaMethod,
                     {boundary, changed.solver.kernel, supportRadius, changed.boundary.directions,
                      changed.boundary.samples, changed.bounds(), &pool,
                      changed.file.string() + (isGamma ? ":/boundary/gamma/method" : ":/boundary/handling"),
                      static_cast<float>(changed.particleSpacing)});
    if (picked.method) handlingName = isGamma ? "gamma: " + picked.name : picked.name;
    if (isGamma) gammaName = picked.name;
  }
  EffectPipeline changedEffects(changed.effects);
  const HealthLimits changedLimits = healthLimits(changed);

  // From here on nothing fails. What goes out of force ends with this function, the method before its walls.
  walls.keep();
  scene.solver = changed.solver;
  scene.boundary = changed.boundary;
  scene.effects.swap(changed.effects);
  std::swap(gamma, picked);
  std::swap(effects, changedEffects);
  statistics.gammaPicked.swap(gammaName);
  statistics.gammaReason.swap(gamma.reason);
  info.handling.swap(handlingName);
  limits = changedLimits;
  step.parameters = scene.solver;
  step.gravity = scene.gravity.cast<float>();
  step.spacing = static_cast<float>(scene.particleSpacing);
  step.supportRadius = supportRadius;
  step.thinWalls.swap(thin);
  step.collisionWalls.swap(barring);
  step.lattice = lattice;
  step.gammaMethod = gamma.method.get();
  step.wallSlots.clear();
  step.wallSlot.clear();
  for (Float4& position : step.particles.position) position.w = 0;  // walls may have other grids now
  info.spacing = step.spacing;
  info.supportRadius = step.supportRadius;
}

Simulation::Simulation(Scene scene, int threads, Guards guards)
    : state_(std::make_unique<State>(std::move(scene), threads, guards)) {
  State& state = *state_;
  fillScene(state.scene, state.boundary, state.step.particles);
  state.configure(settings());
  state.step.pressure.watch(state.scene.view.color == ColorField::pressure);
  // The reader has asked before there were grids of the walls.
  requireMemory(kBytesPerParticle * static_cast<double>(state.step.particles.size()), "particles",
                state.scene.file.string() + ":/particle_spacing");
  if (const long inside = state.step.guards ? stabilise(state.step) : 0; inside > 0) {
    state.statistics.note("started_in_wall", 0,
                          std::to_string(inside) +
                              " particles began nearer than half a spacing to a wall or beyond "
                              "it; they were moved out without gaining speed");
  } else {
    prepareFields(state.step);
    if (const double error = state.step.errors.back().max; state.step.guards && error > kCrowded) {
      relax(state.step);
      state.statistics.note("started_crowded", 0,
                            "sources overlap: density " + std::to_string(1 + error) +
                                " of that at rest; particles were moved apart without gaining speed");
    }
  }
  state.statistics.noteSpread(state.step, 0);
  state.health = inspect(state.step, state.limits);
  state.statistics.energy.begin(state.health.energy, state.step, heightOf(state.step));
  state.info.stateHash = stateHash();
}

Simulation::~Simulation() = default;

void Simulation::State::describeFrame() {
  info.time = time;
  info.steps = statistics.steps;
  info.iterations = step.iterations;
  info.errors = statistics.steps > 0 ? step.errors : std::vector<IterationError>();
  info.stateHash = hash();
  info.energy = statistics.energy.history;
  step.pressure.pressures(step, pressure);
}

/// Walls are where they end up, having been at their places of `before`.
void Simulation::State::moveWalls(double before, double now) {
  boundary.moveTo(before, now);
  drawnWalls.reset();
  if (gamma.method) gamma.method->wallsMoved();
  // What goes along with the walls is not lost.
  for (const auto& wall : boundary.moving()) limits.scene.include(wall->bounds());
}

/// How fast (m/s) particles and walls may come towards each other between `start` and `start + span` (s).
double Simulation::State::largestSpeed(double start, double span) const {
  const double fluid = static_cast<double>(health.maxSpeed) + scene.gravity.norm() * span;
  double wall = 0;
  for (const auto& moving : boundary.moving()) {
    const Bounds own = moving->rest()->bounds();
    wall = std::max(wall, migiwa::largestSpeed(moving->motion(), own.empty() ? scene.bounds() : own, start,
                                               start + span));
  }
  return std::max(fluid, emission.largestSpeed(start, start + span)) + wall;
}

/// Returns the sums of what has come in.
EnergySums Simulation::State::emit(double start) {
  const std::size_t first = step.particles.size();
  emission.emit(start, step, statistics);
  const EnergySums given = energySums(step.particles, first, limits.centre);
  statistics.energy.emitters += given.kinetic + given.potential(scene.gravity);
  return given;
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
  // Velocities are differences of positions, which are rounded.
  const double rounding = 0x1p-24 * limits.farthest / dt * static_cast<double>(health.maxSpeed);
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
  std::ostringstream detail;
  detail << "walls leave the fluid less room than it needs: however long it is solved for, its density stays "
         << 1 + overConstrained.largest << " of that at rest at (" << overConstrained.place.x() << ", "
         << overConstrained.place.y() << ", " << overConstrained.place.z() << ") m, and "
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
      step = std::min(step, state.effects.longestStep(state.step));
    }
    // In doubles: a step that the CFL rule makes short enough has more parts than a whole number holds.
    const double wanted = std::ceil(left / step - 1e-6), most = static_cast<double>(kMostSubsteps - taken);
    double parts = std::max(wanted, 1.0);
    if (!(wanted <= most)) {
      state.statistics.note("cfl_not_met", state.statistics.steps,
                            "the fastest particle would need more than " + std::to_string(kMostSubsteps) +
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
}

long Simulation::frameAt(double time) const {
  return std::lround(std::clamp(time / state_->scene.solver.timeStep, -0x1p62, 0x1p62));
}
long Simulation::frame() const {
  return state_->frame;
}
double Simulation::time() const {
  return state_->time;
}

Settings Simulation::settings() const {
  return {state_->scene.solver, state_->scene.boundary, state_->scene.effects};
}

void Simulation::apply(const Settings& settings) {
  state_->configure(settings);
}

const Scene& Simulation::scene() const {
  return state_->scene;
}

FrameView Simulation::view() const {
  const StepState& step = state_->step;
  const std::span<const std::uint32_t> saved = state_->savedNeighbours;
  return {state_->info,
          step.particles.position,
          step.particles.velocity,
          step.density,
          step.gamma,
          step.lambda,
          saved.empty() ? step.neighbours.counts() : saved,
          state_->pressure,
          step.particles.id};
}

FrameView Simulation::drawnView() const {
  FrameView result = view();
  if (!state_->boundary.moves()) return result;
  if (!state_->drawnWalls) state_->drawnWalls = std::make_shared<const WallDrawing>(walls());
  result.walls = state_->drawnWalls;
  return result;
}

std::vector<Vec3f> Simulation::gammaGradients() const {
  std::vector<Vec3f> gradients(state_->step.particles.size(), Vec3f::Zero());
  for (const WallSlot& slot : state_->step.wallSlots) gradients[slot.particle] = slot.sample.gradient;
  return gradients;
}

void Simulation::watchPressure(bool on) {
  state_->step.pressure.watch(on);
  if (!on) state_->pressure.clear();
}

std::uint64_t Simulation::stateHash() const {
  return state_->hash();
}

const RunStatistics& Simulation::statistics() const {
  return state_->statistics;
}
int Simulation::threads() const {
  return state_->pool.threads();
}
bool Simulation::stopped() const {
  return state_->statistics.failed();
}

bool Simulation::goodState() const {
  const auto finite = [](const Float4& v) { return v.xyz().allFinite(); };
  const Particles& particles = state_->step.particles;
  return state_->statistics.lostParticles == 0 &&
         std::all_of(particles.position.begin(), particles.position.end(), finite) &&
         std::all_of(particles.velocity.begin(), particles.velocity.end(), finite);
}

void Simulation::visitState(StateVisitor& visitor) {
  State& state = *state_;
  visitor.integer("/frame", state.frame);
  visitor.number("/time", state.time);
  visitor.integer("/iterations", state.step.iterations);
  visitor.number("/max_speed", state.health.maxSpeed);  // the CFL rule goes by it
  state.statistics.visit(visitor);
  std::vector<std::uint32_t> neighbours;
  if (!visitor.reading()) {
    const std::span<const std::uint32_t> counts = view().neighbours;
    neighbours.assign(counts.begin(), counts.end());
  }
  visitStepMemory(visitor, state.step, neighbours);
  state.emission.visit(visitor);
  if (!visitor.reading()) return;
  state.savedNeighbours = std::move(neighbours);
  state.step.pressure.clear();
  state.describeFrame();
  // Where walls are follows from the time.
  if (state.boundary.moves()) state.moveWalls(state.time, state.time);
  state.health = inspect(state.step, state.limits);
}

WallDrawing Simulation::walls() const {
  WallDrawing walls;
  Bounds bounds = state_->scene.bounds();
  if (bounds.empty()) {
    // Nothing finite to go by: what the camera looks at.
    const Camera& camera = state_->scene.view.camera;
    bounds.include(camera.target);
    bounds = bounds.grown(0.4 * (camera.eye - camera.target).norm());
  }
  for (const auto& surface : state_->boundary.surfaces()) {
    surface->wireframe(bounds, walls.lines);
    WallMesh mesh = surface->mesh();
    if (!mesh.surface.triangles.empty()) walls.meshes.push_back(std::move(mesh));
    surface->drawnNodes(walls.nodes);
  }
  return walls;
}

void requireSteppable(const BoundaryParameters& boundary, const std::filesystem::path& scene) {
  const auto method = static_cast<std::size_t>(boundary.gammaMethod);
  if (boundary.handling != BoundaryHandling::gamma || method < steppedGammaMethodNames().size()) return;
  throw InputError(scene.string() + ":/boundary/gamma/method",
                   "expected a method that is quick enough for every step, such as \"auto\", found \"" +
                       std::string(gammaMethodNames()[method]) +
                       "\", a reference for migiwa gamma alone; --set /boundary/gamma/method=auto helps");
}

}  // namespace migiwa
