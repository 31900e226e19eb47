#include "core/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/base/progress.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/scene.h"
#include "core/simulation/gauges.h"
#include "core/simulation/run_state.h"
#include "core/simulation/scene_surface.h"
#include "core/simulation/state.h"
#include "core/solver/parameters.h"

namespace migiwa {

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

/// The speed of sound (m/s) that weakly compressible SPH needs in the scene: by the largest speed that its
/// fluid can have, which is that of its sources, emitters and walls and of a fall from its highest to the
/// lowest place. Never less than a frame's step allows, for that costs nothing.
double soundSpeed(const Scene& scene, double given) {
  const WcsphParameters& own = scene.solver.wcsph;
  if (own.soundSpeed > 0) return own.soundSpeed;
  const Bounds all = scene.bounds();
  const double strength = scene.gravity.norm();
  double fall = 0;
  const auto fallsFrom = [&](const Bounds& bounds) {
    if (bounds.empty() || all.empty()) return;
    // Against gravity from the farthest corner of the fluid to that of the scene.
    double gained = 0;
    Vec3d corner;
    for (int axis = 0; axis < 3; ++axis) {
      const double g = scene.gravity[axis];
      corner[axis] = g > 0 ? bounds.min[axis] : bounds.max[axis];
      gained += g * ((g > 0 ? all.max[axis] : all.min[axis]) - corner[axis]);
    }
    // Planes have no bounds: straight down to the first.
    double toPlane = std::numeric_limits<double>::infinity();
    for (const auto& wall : scene.surfaces) {
      if (!wall->bounds().empty()) continue;
      Vec3f normal;
      const auto distance = static_cast<double>(wall->distance(corner.cast<float>(), normal));
      const double against = -scene.gravity.dot(normal.cast<double>());
      if (against > 0) toPlane = std::min(toPlane, strength * strength * std::max(distance, 0.0) / against);
    }
    fall = std::max(fall, std::isfinite(toPlane) ? std::max(gained, toPlane) : gained);
  };
  for (const auto& source : scene.fluid) fallsFrom(source->bounds());
  for (const Emitter& emitter : scene.emitters) fallsFrom(emitter.bounds());
  const double fastest = std::sqrt(given * given + 2 * fall);
  const double free = 0.4 * scene.supportRadius() / scene.solver.timeStep;
  return std::max(fastest / std::sqrt(own.compression), free);
}

}  // namespace

Simulation::State::State(Scene theScene, int threads, Guards guards)
    : scene(std::move(theScene)),
      pool(threads),
      boundary(wallsOf(scene, pool)),
      step(pool, boundary),
      emission(scene, boundary),
      outflow(scene, boundary),
      gauges(scene, boundary) {
  step.guards = guards == Guards::on;
}

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
  WallIndex thin = migiwa::thinWalls(boundary, supportRadius), barring;
  if (step.guards) barring = migiwa::collisionWalls(boundary, supportRadius);
  const RestingLattice lattice = restingLattice(changed.solver.kernel, changed.solver.supportRatio);
  PickedGamma picked;
  std::string handlingName = "no correction", gammaName;
  if (!boundary.empty()) {
    const BoundaryHandling handling = changed.boundary.handling;
    const bool isGamma = handling == BoundaryHandling::gamma;
    GammaContext context = gammaContextOf(changed, boundary, pool);
    if (!isGamma) context.place = changed.file.string() + ":/boundary/handling";
    picked = makeHandling(handling, changed.boundary.gammaMethod, context);
    if (picked.method) handlingName = isGamma ? "gamma: " + picked.name : picked.name;
    if (isGamma) gammaName = picked.name;
  }
  EffectPipeline changedEffects(changed.effects);
  const HealthLimits changedLimits = healthLimits(changed);
  const double sound =
      changed.solver.method == SolverMethod::wcsph
          ? soundSpeed(changed, std::max(changedLimits.given, wallSpeed(0, changed.duration)))
          : 0;

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
  step.thinWalls = std::move(thin);
  step.collisionWalls = std::move(barring);
  step.lattice = lattice;
  step.soundSpeed = static_cast<float>(sound);
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
  std::optional<Activity> activity(std::in_place, "filling the sources");
  fillScene(state.scene, state.boundary, state.step.particles);
  state.statistics.fluid.started = static_cast<std::int64_t>(state.step.particles.size());
  state.statistics.fluid.drains.resize(state.scene.drains.size());
  activity.reset();
  state.configure(settings());
  state.statistics.gauges.resize(state.gauges.size());
  watchPressure(state.scene.view.color == ColorField::pressure);
  // The reader has asked before there were grids of the walls.
  requireMemory(kBytesPerParticle * static_cast<double>(state.step.particles.size()), "particles",
                state.scene.file.string() + ":/particle_spacing");
  activity.emplace("looking at the start");
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
  state.statistics.noteRepairs(state.step, 0);
  state.health = inspect(state.step, state.limits);
  state.statistics.energy.begin(state.health.energy, state.step, heightOf(state.step));
  state.info.stateHash = stateHash();
  state.readGauges();
}

Simulation::~Simulation() = default;

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

std::shared_ptr<const void> Simulation::detach(FrameArray array) {
  const auto leave = [](auto& values) -> std::shared_ptr<const void> {
    auto left = std::make_shared<std::remove_reference_t<decltype(values)>>(values);
    left->swap(values);
    return left;
  };
  StepState& step = state_->step;
  switch (array) {
    case FrameArray::positions:
      return leave(step.particles.position);
    case FrameArray::velocities:
      return leave(step.particles.velocity);
    case FrameArray::density:
      return leave(step.density);
    case FrameArray::gamma:
      return leave(step.gamma);
    case FrameArray::lambda:
      return leave(step.lambda);
    case FrameArray::pressure:
      return leave(state_->pressure);
    case FrameArray::ids:
      return leave(step.particles.id);
  }
  return nullptr;
}

std::vector<Vec3f> Simulation::gammaGradients() const {
  std::vector<Vec3f> gradients(state_->step.particles.size(), Vec3f::Zero());
  for (const WallSlot& slot : state_->step.wallSlots) gradients[slot.particle] = slot.sample.gradient;
  return gradients;
}

void Simulation::watchPressure(bool on) {
  on = on || state_->gauges.readsPressure();
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
  visitor.number("/walls_gave", state.wallsGave);
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
  state.describeGauges();
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
