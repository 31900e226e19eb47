// Every key of a scene file, in the order in which it is best written.
#include <algorithm>
#include <string>
#include <typeinfo>

#include <Eigen/Geometry>

#include "core/boundary/gamma_method.h"
#include "core/scene/default_camera.h"
#include "core/scene/scene_reader.h"

namespace migiwa {

namespace {

// What `describe` needs may change and what a scene holds may not: a writer leaves an object as it finds it,
// and a reader only ever describes objects that it has just made.
template <class T>
T& describable(const std::shared_ptr<const T>& object) {
  return const_cast<T&>(*object);
}

/// The place in `names` of the shape that `object` is, found by its type.
template <class T>
int shapeOf(const T& object, std::span<const std::string_view> names, std::unique_ptr<T> (*make)(int)) {
  for (int shape = 0; shape < static_cast<int>(names.size()); ++shape) {
    const std::unique_ptr<T> example = make(shape);
    const T& candidate = *example;
    if (typeid(candidate) == typeid(object)) return shape;
  }
  return -1;
}

/// A list of objects whose "shape" says what they are. Adds to `objects` what a reader finds. `common`, if
/// given, visits what all shapes share.
template <class T>
void describeShapes(FieldVisitor& visitor, std::string_view key, const FieldDoc& doc,
                    std::vector<std::shared_ptr<const T>>& objects, std::span<const std::string_view> names,
                    std::unique_ptr<T> (*make)(int), const std::function<void(FieldVisitor&, T&)>& describe,
                    const std::function<void(FieldVisitor&, T&)>& common = {}) {
  visitor.list(key, objects.size(), doc, [&](FieldVisitor& element, std::size_t at) {
    int shape = at < objects.size() ? shapeOf(*objects[at], names, make) : -1;
    const int known = shape;
    const std::size_t before = objects.size();
    element.variant("shape", shape, names, {"", "What it is.", Presence::required},
                    [&](FieldVisitor& fields, int picked) {
                      if (picked == known) return describe(fields, describable(objects[at]));
                      std::shared_ptr<T> made = make(picked);
                      describe(fields, *made);
                      objects.push_back(std::move(made));
                    });
    if (!common) return;
    if (known >= 0) {
      common(element, describable(objects[at]));
    } else if (objects.size() > before) {
      common(element, describable(objects.back()));
    }
  });
}

void describeFluid(FieldVisitor& visitor, Scene& scene) {
  const bool spacingKnown = visitor.sound({"particle_spacing"});
  describeShapes<FluidSource>(
      visitor, "fluid", {"", "Regions that are full of fluid at the start. None at all is valid."},
      scene.fluid, fluidShapes(), makeFluidSource, [&](FieldVisitor& fields, FluidSource& source) {
        source.describe(fields);
        fields.vector("velocity", source.velocity, {"m/s", "Velocity at the start."});
        fields.boolean("trim", source.trim,
                       {"", "Leave out particles less than half a spacing inside the fluid side of a wall."});
        if (spacingKnown && fields.sound({"min", "max", "center", "radius", "file", "transform"}) &&
            source.count(scene.particleSpacing) < 1)
          fields.fault("",
                       "expected a region with room for a particle, found one thinner than half of "
                       "particle_spacing");
      });
}

void describeEmitters(FieldVisitor& visitor, Scene& scene) {
  const double spacing = visitor.sound({"particle_spacing"}) ? scene.particleSpacing : 0;
  visitor.list("emitters", scene.emitters.size(), {"", "Mouths that give fluid while the simulation runs."},
               [&](FieldVisitor& fields, std::size_t at) {
                 if (at >= scene.emitters.size()) scene.emitters.emplace_back();
                 scene.emitters[at].describe(fields, spacing);
               });
}

void describeMotion(FieldVisitor& visitor, std::optional<Motion>& motion) {
  bool present = motion.has_value();
  visitor.object(
      "motion", {"", "How the wall moves; left out, it stands still. What is named here adds up."},
      [&](FieldVisitor& fields) {
        if (!motion) motion.emplace();
        motion->describe(fields);
      },
      &present);
}

void describeBoundary(FieldVisitor& visitor, Scene& scene) {
  BoundaryParameters& boundary = scene.boundary;
  visitor.choice(
      "handling", boundary.handling, handlingNames(),
      {"",
       "How the density is corrected at walls: by gamma, by one of the methods that it is compared "
       "with, or not at all; none only keeps the particles out."});
  visitor.object("gamma", {"", "How gamma, the uncovered part of the kernel, is found."},
                 [&](FieldVisitor& fields) {
                   fields.choice("method", boundary.gammaMethod, gammaMethodNames(),
                                 {"",
                                  "The approximation; auto picks by the shapes of the walls, mean is the "
                                  "paper's Eq. 14."});
                   fields.integer("directions", boundary.directions, Range::closed(8, 65536),
                                  {"1", "Directions of the method directions."});
                   fields.integer("samples", boundary.samples, Range::closed(100, 1e8),
                                  {"1", "Samples of the method monte_carlo."});
                 });
  describeShapes<Surface>(
      visitor, "surfaces", {"", "Walls. The fluid is on the fluid side of all of them."}, scene.surfaces,
      surfaceShapes(), makeSurface, [](FieldVisitor& fields, Surface& surface) { surface.describe(fields); },
      [](FieldVisitor& fields, Surface& surface) { describeMotion(fields, surface.motion); });
}

void describeSolver(FieldVisitor& visitor, SolverParameters& solver) {
  visitor.number("time_step", solver.timeStep, Range::positive(1), {"s", "Time from one frame to the next."});
  visitor.integer("substeps", solver.substeps, Range::closed(1, 1000),
                  {"1", "Parts that a frame is divided into, at least."});
  visitor.number("cfl", solver.cfl, Range::closed(0, 10),
                 {"1",
                  "Support radii that the fastest particle may move in a substep; 0 for no such limit, nor "
                  "those of effects."});
  visitor.integer("min_iterations", solver.minIterations, Range::closed(1, 1000),
                  {"1", "Iterations of a substep, at least."});
  visitor.integer("max_iterations", solver.maxIterations, Range::closed(1, 1000),
                  {"1", "Iterations of a substep, at most."});
  if (visitor.sound({"min_iterations", "max_iterations"}) && solver.minIterations > solver.maxIterations)
    visitor.fault("min_iterations", "expected at most max_iterations, which is " +
                                        std::to_string(solver.maxIterations) + ", found " +
                                        std::to_string(solver.minIterations));
  visitor.number("tolerance", solver.tolerance, Range::halfOpen(0, 1),
                 {"1", "Largest mean density error that ends the iterations."});
  visitor.number(
      "cfm_epsilon", solver.cfmEpsilon, Range::positive(1e6),
      {"1", "Softening of lambda, over the resting lattice's sum of squared constraint gradients."});
  visitor.choice(
      "kernel", solver.kernel, kKernelNames,
      {"",
       "Kernel of the density; the pair gradient is Spiky's for poly6 and spiky, its own for the others."});
  visitor.number("support_ratio", solver.supportRatio, Range::closed(1.2, 4),
                 {"1", "Support radius over particle spacing."});
  visitor.choice(
      "position_step", solver.positionStep, kPositionStepNames,
      {"",
       "How lambda becomes a displacement: by the full gradient of the constraint, by the pairs and "
       "the wall alone, or by Eq. 10 of the paper as printed."});
  visitor.choice("acceleration", solver.acceleration, kAccelerationNames,
                 {"",
                  "How the iterations are made to converge in fewer: the Chebyshev semi-iteration, or the "
                  "paper's plain iteration."});
  visitor.number("rest_density", solver.restDensity, Range::positive(1e6),
                 {"kg/m^3", "Density of the fluid at rest."});
}

/// Each effect is an object of its own key, and runs when the key is there.
void describeEffects(FieldVisitor& visitor, std::vector<NamedEffect>& effects) {
  const auto names = effectNames();
  for (std::size_t at = 0; at < names.size(); ++at) {
    const auto known = std::find_if(effects.begin(), effects.end(),
                                    [&](const NamedEffect& effect) { return effect.name == names[at]; });
    std::shared_ptr<const Effect> found = known != effects.end() ? known->effect : nullptr;
    bool present = found != nullptr;
    visitor.object(
        names[at], {"", "An effect; {} runs it with its defaults."},
        [&](FieldVisitor& fields) {
          if (found != nullptr) return describable(found).describe(fields);
          std::shared_ptr<Effect> made = makeEffect(static_cast<int>(at));
          made->describe(fields);
          effects.push_back({std::string(names[at]), std::move(made)});
        },
        &present);
  }
}

void describeCamera(FieldVisitor& visitor, Camera& camera) {
  visitor.vector("eye", camera.eye, {"m", "Where the camera is.", Presence::required});
  visitor.vector("target", camera.target, {"m", "What it looks at.", Presence::required});
  visitor.vector("up", camera.up, {"1", "The direction that is up in the picture."});
  visitor.number("fov_degrees", camera.fovDegrees, Range::closed(1, 120),
                 {"degrees", "Vertical field of view."});
  const Vec3d ahead = camera.target - camera.eye;
  if (visitor.sound({"eye", "target"}) && ahead.norm() < 1e-9)
    visitor.fault("target", "expected a point away from eye, found the same point");
  if (visitor.sound({"up"}) && camera.up.norm() < 1e-9)
    visitor.fault("up", "expected a vector that is not zero, found [0, 0, 0]");
  const double across = ahead.cross(camera.up).norm();
  if (visitor.sound({"eye", "target", "up"}) && across < 1e-6 * ahead.norm() * camera.up.norm())
    visitor.fault("up", "expected a direction across the line of sight, found one along it");
}

void describeView(FieldVisitor& visitor, View& view, bool& cameraPresent) {
  visitor.object(
      "camera", {"", "Left out: one that sees the whole scene."},
      [&](FieldVisitor& fields) { describeCamera(fields, view.camera); }, &cameraPresent);
  visitor.object(
      "clip", {"", "Cuts away what lies beyond the plane towards the camera."},
      [&](FieldVisitor& fields) {
        fields.choice("axis", view.clip.axis, kAxisNames, {"", "The plane's normal.", Presence::required});
        fields.number("at", view.clip.at, kCoordinateRange,
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
}

}  // namespace

void describeScene(FieldVisitor& visitor, Scene& scene) {
  std::string schema;
  visitor.text("$schema", schema, {"", "For editors; not read."});
  int format = 1;
  visitor.integer("format", format, Range::closed(1, 1),
                  {"", "Version of the scene format.", Presence::required});
  visitor.text("name", scene.name, {"", "A short title; left out: the file's name."});
  visitor.text("description", scene.description, {"", "What the scene shows and what to look for."});
  visitor.number("duration", scene.duration, Range::positive(1e6),
                 {"s", "How long a run is unless told otherwise."});
  visitor.number("particle_spacing", scene.particleSpacing, Range::positive(1e3),
                 {"m", "Distance of neighbouring particles at rest."});
  visitor.vector("gravity", scene.gravity, {"m/s^2", "Acceleration of all of the fluid."});
  describeFluid(visitor, scene);
  describeEmitters(visitor, scene);
  visitor.object("boundary", {"", "The walls and how the density is corrected at them."},
                 [&](FieldVisitor& fields) { describeBoundary(fields, scene); });
  visitor.object("solver", {"", "The constraint solver."},
                 [&](FieldVisitor& fields) { describeSolver(fields, scene.solver); });
  visitor.object("effects",
                 {"", "What acts on the fluid beside pressure and gravity; only what is named here runs."},
                 [&](FieldVisitor& fields) { describeEffects(fields, scene.effects); });
  bool cameraPresent = true;
  bool viewPresent = true;
  visitor.object(
      "view", {"", "What pictures show."},
      [&](FieldVisitor& fields) { describeView(fields, scene.view, cameraPresent); }, &viewPresent);
  if (!viewPresent || !cameraPresent) scene.view.camera = defaultCamera(scene.bounds(), scene.gravity);
}

}  // namespace migiwa
