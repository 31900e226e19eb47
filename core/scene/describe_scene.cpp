// Every key of a scene file, in the order in which it is best written.
#include <algorithm>
#include <string>
#include <string_view>
#include <typeinfo>

#include <Eigen/Geometry>

#include "core/base/messages.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"

namespace migiwa {

namespace {

template <class Visitor>
void describeFluid(Visitor& visitor, Visited<Visitor, Scene>& scene) {
  const bool spacingKnown = visitor.valid({"particle_spacing"});
  const auto more = [&](auto& fields, auto& source) {
    FluidSource::describeMotion(fields, source);
    fields.boolean("trim", source.trim,
                   {"",
                    "Leave out particles less than half a spacing inside the fluid side of a wall, or nearer "
                    "than 0.9 spacings to one of an earlier source."});
    if (Visitor::kChanges && spacingKnown &&
        fields.valid({"min", "max", "center", "radius", "file", "transform"}) &&
        source.count(scene.particleSpacing) < 1)
      fields.fault("",
                   "expected a region with room for a particle, found one thinner than half of "
                   "particle_spacing");
  };
  const auto nothing = [](auto&, auto&) {};
  describeShapes<FluidSource>(visitor, "fluid",
                              {"", "Regions that are full of fluid at the start. None at all is valid."},
                              scene.fluid, {fluidShapes(), makeFluidSource}, more, nothing);
}

template <class Visitor>
void describeEmitters(Visitor& visitor, Visited<Visitor, Scene>& scene) {
  const double spacing = visitor.valid({"particle_spacing"}) ? scene.particleSpacing : 0;
  auto& emitters = scene.emitters;
  visitor.list("emitters", emitters.size(), {"", "Mouths that give fluid while the simulation runs."},
               [&](auto& fields, std::size_t at) {
                 if constexpr (Visitor::kChanges) {
                   if (at >= emitters.size()) emitters.emplace_back();
                   emitters[at].describe(fields, spacing);
                 } else {
                   emitters[at].describe(fields);
                 }
               });
}

template <class Visitor>
void describeDrains(Visitor& visitor, Visited<Visitor, Scene>& scene) {
  const double spacing = visitor.valid({"particle_spacing"}) ? scene.particleSpacing : 0;
  auto& drains = scene.drains;
  visitor.list("drains", drains.size(), {"", "Regions that take fluid away while the simulation runs."},
               [&](auto& fields, std::size_t at) {
                 if constexpr (Visitor::kChanges) {
                   if (at >= drains.size()) drains.emplace_back();
                   drains[at].describe(fields, spacing);
                 } else {
                   drains[at].describe(fields);
                 }
               });
}

template <class Visitor>
void describeGauges(Visitor& visitor, Visited<Visitor, Scene>& scene) {
  auto& gauges = scene.gauges;
  visitor.list("gauges", gauges.size(), {"", "What is measured over time, for the report and as series."},
               [&](auto& fields, std::size_t at) {
                 if constexpr (Visitor::kChanges) {
                   if (at >= gauges.size()) gauges.emplace_back();
                   Gauge& gauge = gauges[at];
                   gauge.describe(fields, at);
                   const auto walls = static_cast<int>(scene.surfaces.size());
                   if (gauge.wall >= walls && fields.valid({"wall"}))
                     fields.fault("wall", "expected the number of one of the " + std::to_string(walls) +
                                              " surfaces, counted from 0, found " +
                                              std::to_string(gauge.wall));
                   for (std::size_t before = 0; before < at; ++before)
                     if (gauges[before].name == gauge.name)
                       fields.fault("name", "expected a name that no other gauge has, found that of gauges/" +
                                                std::to_string(before));
                 } else {
                   gauges[at].describe(fields);
                 }
               });
}

template <class Visitor>
void describeDomain(Visitor& visitor, Visited<Visitor, Domain>& domain) {
  visitor.object(
      "bounds",
      {"",
       "Particles that leave this box are removed and counted; left out: ten diagonals of the scene beyond "
       "its fluid and walls, and everywhere in a scene without walls."},
      [&](auto& fields) {
        fields.place("min", domain.min, {"m", "Corner with the smallest coordinates.", Presence::required});
        fields.place("max", domain.max, {"m", "Corner with the largest coordinates.", Presence::required});
        if (fields.valid({"min", "max"}) && (domain.max.array() <= domain.min.array()).any())
          fields.fault("max",
                       "expected every coordinate to be larger than that of min, found one that is not");
      },
      &domain.given);
}

/// A source of which nothing would be there after a step, a drain that nothing reaches.
void warnOfFluidOutside(FieldVisitor& visitor, const Scene& scene) {
  if (!scene.domain.given || !visitor.valid({"bounds", "fluid", "emitters", "drains"})) return;
  const Bounds domain = scene.domainBounds();
  const auto outside = [&](const Bounds& own) {
    return !own.empty() &&
           ((own.max.array() < domain.min.array()).any() || (own.min.array() > domain.max.array()).any());
  };
  for (std::size_t k = 0; k < scene.fluid.size(); ++k)
    if (outside(scene.fluid[k]->bounds()))
      visitor.warning("bounds", "fluid/" + std::to_string(k) + " lies outside and leaves at once");
  for (std::size_t k = 0; k < scene.emitters.size(); ++k)
    if (outside(scene.emitters[k].bounds()))
      visitor.warning("bounds",
                      "emitters/" + std::to_string(k) + " lies outside: what it gives leaves at once");
  for (std::size_t k = 0; k < scene.drains.size(); ++k)
    if (outside(DrainRegion(scene.drains[k]).bounds()))
      visitor.warning("bounds", "drains/" + std::to_string(k) + " lies outside and never takes anything");
}

template <class Visitor>
void describeMotion(Visitor& visitor, Visited<Visitor, std::optional<Motion>>& motion) {
  bool present = motion.has_value();
  visitor.object(
      "motion", {"", "How the wall moves; left out, it stands still. What is named here adds up."},
      [&](auto& fields) {
        if constexpr (Visitor::kChanges)
          if (!motion) motion.emplace();
        motion->describe(fields);
      },
      &present);
}

template <class Visitor>
void describeGamma(Visitor& visitor, Visited<Visitor, BoundaryParameters>& boundary) {
  visitor.choice("method", boundary.gammaMethod, gammaMethodNames(),
                 {"",
                  "The approximation; auto picks by the shapes of the walls, mean is the paper's Eq. 14, and "
                  "monte_carlo is for migiwa gamma alone."});
  visitor.integer("directions", boundary.directions, Range::closed(8, 65536),
                  {"1", "Directions of the method directions."});
  visitor.integer("samples", boundary.samples, Range::closed(100, 1e8),
                  {"1", "Samples of the method monte_carlo."});
}

template <class Visitor>
void describeBoundary(Visitor& visitor, Visited<Visitor, Scene>& scene) {
  auto& boundary = scene.boundary;
  visitor.choice(
      "handling", boundary.handling, handlingNames(),
      {"",
       "How the density is corrected at walls: by gamma, by one of the methods that it is compared "
       "with, or not at all; none only keeps the particles out, and penalty pushes by depth."});
  visitor.object("gamma", {"", "How gamma, the uncovered part of the kernel, is found."},
                 [&](auto& fields) { describeGamma(fields, boundary); });
  const auto nothing = [](auto&, auto&) {};
  describeShapes<Surface>(visitor, "surfaces", {"", "Walls. The fluid is on the fluid side of all of them."},
                          scene.surfaces, {surfaceShapes(), makeSurface}, nothing,
                          [](auto& fields, auto& surface) { describeMotion(fields, surface.motion); });
}

template <class Visitor>
void describeWcsph(Visitor& visitor, Visited<Visitor, WcsphParameters>& wcsph) {
  visitor.number(
      "compression", wcsph.compression, Range::closed(1e-4, 0.1),
      {"1",
       "Compression that the speed of sound is chosen for: it is the largest speed of the flow over "
       "the root of it. That speed is of a fall from the highest fluid to the lowest place."});
  visitor.number("sound_speed", wcsph.soundSpeed, Range::closed(0, 1e5),
                 {"m/s", "Speed of sound; 0: by the compression. Steps are as short as it asks."});
  visitor.number("viscosity", wcsph.viscosity, Range::closed(0, 1),
                 {"1", "Artificial viscosity alpha, which keeps the sound from growing."});
}

/// The method, and what goes with it.
template <class Visitor>
void describeMethod(Visitor& visitor, Visited<Visitor, SolverParameters>& solver) {
  visitor.choice(
      "method", solver.method, kSolverMethodNames,
      {"",
       "How the fluid is kept from being compressed: pbf, Position Based Fluids; wcsph, a stiff "
       "equation of state; pcisph, pressures that grow by the density that they lead to; dfsph, by "
       "density and divergence (docs/method.md). With all but pbf the defaults are kernel "
       "wendland_c2 and support_ratio 2.25, with pcisph min_iterations 3 and max_iterations 50, "
       "with dfsph max_iterations 50, tolerance 0.001 and divergence_tolerance 0.001."});
  if constexpr (Visitor::kChanges)
    if (solver.method != SolverMethod::pbf) solver.takeMethod(solver.method);
  const std::string_view name = kSolverMethodNames[static_cast<std::size_t>(solver.method)];
  bool present = solver.method == SolverMethod::wcsph;
  visitor.object(
      "wcsph", {"", "Of the method wcsph."}, [&](auto& fields) { describeWcsph(fields, solver.wcsph); },
      &present);
  if (present && solver.method != SolverMethod::wcsph)
    visitor.warning("wcsph", "is not used by the method \"" + std::string(name) + "\"");
}

/// A scene that was written for PBF may ask other methods for less than what they stand for.
template <class Visitor>
void warnOfPbfsOwn(Visitor& visitor, const SolverParameters& solver) {
  const bool iterates = solver.method == SolverMethod::pcisph || solver.method == SolverMethod::dfsph;
  if (!iterates || !visitor.valid({"min_iterations", "tolerance"})) return;
  SolverParameters own;
  own.takeMethod(solver.method);
  const auto warn = [&](std::string_view key, double found, double its) {
    visitor.warning(key, formatNumber("%.6g", found) + " is that of the scene; " +
                             std::string(kSolverMethodNames[static_cast<std::size_t>(solver.method)]) +
                             "'s own is " + formatNumber("%.6g", its));
  };
  if (solver.minIterations < own.minIterations)
    warn("min_iterations", solver.minIterations, own.minIterations);
  if (solver.tolerance > own.tolerance) warn("tolerance", solver.tolerance, own.tolerance);
}

/// Where velocities come from, the kernel and the form of a displacement. What is not written follows from
/// what is: the paper's own step, and kernels whose own gradient does not move particles, go with velocities
/// from positions.
template <class Visitor>
void describeVelocities(Visitor& visitor, Visited<Visitor, SolverParameters>& solver) {
  visitor.choice("kernel", solver.kernel, kKernelNames,
                 {"",
                  "Kernel of the density; the pair gradient is Spiky's for poly6 and spiky, its own for the "
                  "others. Left "
                  "out: wendland_c2, and poly6 where velocities come from positions."});
  visitor.choice(
      "position_step", solver.positionStep, kPositionStepNames,
      {"",
       "How lambda becomes a displacement: by the full gradient of the constraint, by the pairs and "
       "the wall alone, or by Eq. 10 of the paper as printed."});
  [[maybe_unused]] const auto take = [&](VelocityStep from) {
    if constexpr (Visitor::kChanges) {
      const KernelType kernel = solver.kernel;
      solver.takeVelocities(from);
      if (visitor.given("kernel")) solver.kernel = kernel;
    }
  };
  const bool isPbf = solver.method == SolverMethod::pbf;
  if (isPbf && (!servesPressure(solver.kernel) || solver.positionStep != PositionStep::gradient))
    take(VelocityStep::positions);
  [[maybe_unused]] const VelocityStep usual = solver.velocityStep;
  visitor.choice(
      "velocity_step", solver.velocityStep, kVelocityStepNames,
      {"",
       "Of pbf, where velocities come from: from a pressure that makes them free of divergence, while the "
       "constraint corrects positions alone, so that waves keep their height, or from the way that the "
       "constraint has moved particles, as the paper has it. Left out: projection, and positions with the "
       "kernels poly6 and spiky, the other position steps and surface tension. Defaults go with it: kernel "
       "wendland_c2, support_ratio 2.25, tolerance 0.003 and min_iterations 1, or poly6, 2, 0.01 and 2."});
  if (isPbf && solver.velocityStep != usual) take(solver.velocityStep);
  if (!isPbf && visitor.given("velocity_step"))
    visitor.warning("velocity_step", "belongs to the method \"pbf\" and is not used");
  const std::string_view chosenBy = isPbf ? "velocity_step" : "method";
  if (solver.takesPressure() && visitor.valid({"kernel", chosenBy}) && !servesPressure(solver.kernel))
    visitor.fault(
        chosenBy,
        "expected a kernel whose own gradient moves particles, \"kernel\": \"wendland_c2\" or "
        "\"cubic_spline\", for \"" +
            std::string(isPbf ? "projection" : kSolverMethodNames[static_cast<std::size_t>(solver.method)]) +
            "\"; found \"" + std::string(kKernelNames[static_cast<std::size_t>(solver.kernel)]) + "\"");
}

template <class Visitor>
void describeSolver(Visitor& visitor, Visited<Visitor, SolverParameters>& solver) {
  describeMethod(visitor, solver);
  describeVelocities(visitor, solver);
  visitor.number("time_step", solver.timeStep, Range::closed(1e-9, 1),
                 {"s", "Time from one frame to the next."});
  visitor.integer("substeps", solver.substeps, Range::closed(1, 1000),
                  {"1", "Parts that a frame is divided into, at least."});
  visitor.number("cfl", solver.cfl, Range::closed(0, 10),
                 {"1",
                  "Support radii that the fastest particle may move in a substep; 0 for no such limit, nor "
                  "those of effects; that of wcsph's sound stays."});
  visitor.integer("min_iterations", solver.minIterations, Range::closed(1, 1000),
                  {"1", "Iterations of a substep, at least."});
  visitor.integer("max_iterations", solver.maxIterations, Range::closed(1, 1000),
                  {"1", "Iterations of a substep, at most."});
  if (visitor.valid({"min_iterations", "max_iterations"}) && solver.minIterations > solver.maxIterations)
    visitor.fault("min_iterations", "expected at most max_iterations, which is " +
                                        std::to_string(solver.maxIterations) + ", found " +
                                        std::to_string(solver.minIterations));
  visitor.number("tolerance", solver.tolerance, Range::halfOpen(0, 1),
                 {"1", "Largest mean density error that ends the iterations."});
  warnOfPbfsOwn(visitor, solver);
  visitor.number(
      "cfm_epsilon", solver.cfmEpsilon, Range::closed(1e-9, 1e6),
      {"1", "Softening of lambda, over the resting lattice's sum of squared constraint gradients."});
  visitor.number("support_ratio", solver.supportRatio, Range::closed(1.2, 4),
                 {"1", "Support radius over particle spacing."});
  visitor.choice("acceleration", solver.acceleration, kAccelerationNames,
                 {"",
                  "How the iterations are made to converge in fewer: the Chebyshev semi-iteration, or the "
                  "paper's plain iteration."});
  visitor.number(
      "divergence_tolerance", solver.divergenceTolerance, Range::halfOpen(0, 1),
      {"1", "Of a projection and of dfsph: mean divergence times time step that ends its iterations."});
  visitor.integer("max_pressure_iterations", solver.maxPressureIterations, Range::closed(1, 1000),
                  {"1", "Of a projection and of dfsph: iterations against divergence, at most."});
  visitor.number("rest_density", solver.restDensity, Range::closed(1e-6, 1e6),
                 {"kg/m^3", "Density of the fluid at rest."});
}

/// Each effect is an object of its own key, and runs when the key is there.
constexpr FieldDoc kEffectDoc{"", "An effect; {} runs it with its defaults."};

template <class Visitor>
void describeEffects(Visitor& visitor, Visited<Visitor, std::vector<NamedEffect>>& effects) {
  const auto names = effectNames();
  for (std::size_t at = 0; at < names.size(); ++at) {
    const auto known = std::find_if(effects.begin(), effects.end(),
                                    [&](const NamedEffect& effect) { return effect.name == names[at]; });
    bool present = known != effects.end();
    const auto fields = [&](Visitor& effect) {
      if constexpr (Visitor::kChanges) {
        std::shared_ptr<Effect> made = makeEffect(static_cast<int>(at));
        made->describe(effect);
        effects.push_back({std::string(names[at]), std::move(made)});
      } else {
        known->effect->describe(effect);
      }
    };
    visitor.object(names[at], kEffectDoc, fields, &present);
  }
}

template <class Visitor>
void describeCamera(Visitor& visitor, Visited<Visitor, Camera>& camera) {
  visitor.place("eye", camera.eye, {"m", "Where the camera is.", Presence::required});
  visitor.place("target", camera.target, {"m", "What it looks at.", Presence::required});
  visitor.vector("up", camera.up, {"1", "The direction that is up in the picture."});
  visitor.number("fov_degrees", camera.fovDegrees, Range::closed(1, 120),
                 {"degrees", "Vertical field of view."});
  const Vec3d ahead = camera.target - camera.eye;
  if (visitor.valid({"eye", "target"}) && ahead.norm() < 1e-9)
    visitor.fault("target", "expected a point away from eye, found the same point");
  if (visitor.valid({"up"}) && camera.up.norm() < 1e-9)
    visitor.fault("up", "expected a vector that is not zero, found [0, 0, 0]");
  const double across = ahead.cross(camera.up).norm();
  if (visitor.valid({"eye", "target", "up"}) && across < 1e-6 * ahead.norm() * camera.up.norm())
    visitor.fault("up", "expected a direction across the line of sight, found one along it");
}

template <class Visitor>
void describeShares(Visitor& visitor, std::string_view key, Visited<Visitor, Vec3d>& shares, double least,
                    const FieldDoc& doc) {
  visitor.vector(key, shares, doc);
  if (visitor.valid({key}) && (shares.minCoeff() < least || shares.maxCoeff() > 1))
    visitor.fault(key, least > 0 ? "expected red, green and blue from 0.001 to 1, found one that is not"
                                 : "expected red, green and blue from 0 to 1, found one that is not");
}

template <class Visitor>
void describeLook(Visitor& visitor, Visited<Visitor, Look>& look, std::size_t surfaces) {
  describeShares(
      visitor, "water_color", look.waterColor, 1e-3,
      {"1", "Red, green and blue that white light keeps on its way through water of water_depth."});
  visitor.number("water_depth", look.waterDepth, Range::length(kLargestCoordinate),
                 {"m", "The way through water after which light has water_color."});
  describeShares(visitor, "matt_color", look.mattColor, 0,
                 {"1", "Red, green and blue that matt walls throw back."});
  visitor.number(
      "light_turn", look.lightTurn, Range::closed(-360, 360),
      {"degrees", "Turns the light about the up axis, from its place behind the scene and to the left."});
  visitor.list("walls", look.walls.size(), {"", "The materials of boundary/surfaces, in their order."},
               [&](auto& wall, std::size_t at) {
                 if constexpr (Visitor::kChanges) look.walls.resize(at + 1);
                 wall.choice("material", look.walls[at], kWallMaterialNames,
                             {"",
                              "Of what the wall is: auto is glass for what holds the fluid and matt for what "
                              "stands in it; hidden is not shown at all.",
                              Presence::required});
               });
  if (look.walls.size() > surfaces)
    visitor.fault("walls", "expected at most one entry for each of boundary/surfaces (" +
                               std::to_string(surfaces) + "), found " + std::to_string(look.walls.size()));
}

template <class Visitor>
void describeView(Visitor& visitor, Visited<Visitor, View>& view, std::size_t surfaces, bool& cameraPresent) {
  visitor.object(
      "camera", {"", "Left out: one that sees the whole scene."},
      [&](auto& fields) { describeCamera(fields, view.camera); }, &cameraPresent);
  visitor.object(
      "clip", {"", "Cuts away what lies beyond the plane towards the camera."},
      [&](auto& fields) {
        fields.choice("axis", view.clip.axis, kAxisNames, {"", "The plane's normal.", Presence::required});
        fields.coordinate("at", view.clip.at, static_cast<int>(view.clip.axis),
                          {"m", "Its place on the axis.", Presence::required});
      },
      &view.clip.enabled);
  visitor.boolean(
      "nodes", view.nodes,
      {"", "Show SLIM walls as discs, one for each of their balls, coloured by the ball's radius."});
  visitor.choice("color", view.color, kColorFieldNames, {"", "The quantity that colours the particles."});
  visitor.pair(
      "color_range", view.colorRange,
      {"", "Values at the ends of the colour map, in the unit of the quantity; left out: its usual range."},
      &view.hasColorRange);
  if (view.hasColorRange && view.colorRange[0] >= view.colorRange[1])
    visitor.fault("color_range", "expected the smaller value first, found it last");
  visitor.object("look", {"", "How ray-traced pictures show water and walls."},
                 [&](auto& fields) { describeLook(fields, view.look, surfaces); });
}

/// Returns whether there is a camera.
template <class Visitor>
bool fieldsOf(Visitor& visitor, Visited<Visitor, Scene>& scene) {
  std::string schema;
  visitor.text("$schema", schema, {"", "For editors; not read."});
  int format = 1;
  visitor.integer("format", format, Range::closed(1, 1),
                  {"", "Version of the scene format.", Presence::required});
  visitor.text("name", scene.name, {"", "A short title; left out: the file's name."});
  visitor.text("description", scene.description, {"", "What the scene shows and what to look for."});
  visitor.number("duration", scene.duration, Range::positive(1e6),
                 {"s", "How long a run is unless told otherwise."});
  visitor.number("particle_spacing", scene.particleSpacing, Range::closed(1e-7, 1e3),
                 {"m", "Distance of neighbouring particles at rest."});
  visitor.vector("gravity", scene.gravity, {"m/s^2", "Acceleration of all of the fluid."});
  describeFluid(visitor, scene);
  describeEmitters(visitor, scene);
  describeDrains(visitor, scene);
  describeDomain(visitor, scene.domain);
  if constexpr (Visitor::kChanges) warnOfFluidOutside(visitor, scene);
  visitor.object("boundary", {"", "The walls and how the density is corrected at them."},
                 [&](auto& fields) { describeBoundary(fields, scene); });
  describeGauges(visitor, scene);
  if constexpr (Visitor::kChanges)
    if (visitor.given("/effects/surface_tension")) scene.solver.takeVelocities(VelocityStep::positions);
  visitor.object("solver", {"", "The constraint solver."},
                 [&](auto& fields) { describeSolver(fields, scene.solver); });
  visitor.object("effects",
                 {"", "What acts on the fluid beside pressure and gravity; only what is named here runs."},
                 [&](auto& fields) { describeEffects(fields, scene.effects); });
  bool cameraPresent = true;
  bool viewPresent = true;
  visitor.object(
      "view", {"", "What pictures show."},
      [&](auto& fields) { describeView(fields, scene.view, scene.surfaces.size(), cameraPresent); },
      &viewPresent);
  return viewPresent && cameraPresent;
}

}  // namespace

void describeScene(FieldVisitor& visitor, Scene& scene) {
  if (!fieldsOf(visitor, scene)) scene.view.camera = defaultCamera(scene.bounds(), scene.gravity);
}

void describeScene(FieldWriter& visitor, const Scene& scene) {
  fieldsOf(visitor, scene);
}

}  // namespace migiwa
