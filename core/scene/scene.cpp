#include "core/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <Eigen/Geometry>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/walls/moving.h"

namespace migiwa {

Bounds Scene::bounds() const {
  Bounds bounds;
  for (const auto& source : fluid) bounds.include(source->bounds());
  for (const Emitter& emitter : emitters) bounds.include(emitter.bounds());
  for (const auto& surface : surfaces) bounds.include(sweptBounds(*surface, duration));
  return bounds;
}

Bounds Scene::domainBounds() const {
  if (domain.given) {
    Bounds given;
    given.min = domain.min, given.max = domain.max;
    return given;
  }
  const Bounds extent = bounds();
  return surfaces.empty() || extent.empty() ? Bounds() : extent.grown(10 * extent.size().norm());
}

Camera defaultCamera(const Bounds& bounds, const Vec3d& gravity) {
  Camera camera;
  if (gravity.norm() > 0) camera.up = Vec3d::Zero() - gravity.normalized();  // 0 - 0 has no sign to show
  // The front is +z as long as that is level, else -y.
  const Vec3d level = std::abs(camera.up.z()) < 0.9 ? Vec3d::UnitZ() : Vec3d(-Vec3d::UnitY());
  const Vec3d front = (level - level.dot(camera.up) * camera.up).normalized();
  const Vec3d right = camera.up.cross(front);
  const Vec3d towardsEye = (front + 0.35 * right + 0.4 * camera.up).normalized();
  const double radius = bounds.empty() ? 1 : std::max(0.5 * bounds.size().norm(), 1e-6);
  camera.target = bounds.empty() ? Vec3d(Vec3d::Zero()) : bounds.center();
  camera.eye =
      camera.target + radius / std::sin(0.5 * camera.fovDegrees * std::numbers::pi / 180) * towardsEye;
  return camera;
}

namespace {

/// With so many significant digits, and never fewer than the whole ones unless there are very many.
std::string digits(double value, int significant) {
  const std::string shortest = "%." + std::to_string(significant) + "g";
  return formatNumber(value >= 100 && value < 1e9 ? "%.0f" : shortest.c_str(), value);
}

/// Quotients of decimal numbers miss whole ones by what a double cannot hold.
constexpr double kRounding = 1e-10;

/// A spacing (m) of two digits that makes at most so many particles; nothing where there is none below the
/// largest that a scene may have.
std::optional<double> coarseEnough(const std::function<double(double)>& count, double spacing, double most) {
  constexpr double kLargestSpacing = 1e3;
  // The count of a solid goes with the spacing to the power of -3, that of thin things with a lower one.
  double enough = 1.02 * spacing * std::cbrt(count(spacing) / most);
  while (enough <= kLargestSpacing) {
    const double rounded = shownRoundedUp(enough);
    if (count(rounded) <= most) return rounded;
    enough = 1.05 * rounded;
  }
  return std::nullopt;
}

}  // namespace

double shownRoundedUp(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::ceil((1 - kRounding) * value / unit) * unit;
}

double shownRoundedDown(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::floor((1 + kRounding) * value / unit) * unit;
}

double mostParticles(double memory) {
  return std::min(kLargestCount, std::floor(memory / kBytesPerParticle));
}

double particleCount(const Scene& scene, double spacing, double time) {
  double particles = 0;
  for (const auto& source : scene.fluid) particles += source->count(spacing);
  for (const Emitter& emitter : scene.emitters) particles += emitter.count(spacing, time);
  return particles;
}

double particleCount(const Scene& scene) {
  return particleCount(scene, scene.particleSpacing, scene.duration);
}

std::optional<std::string> tooManyParticles(const std::function<double(double)>& count, double spacing,
                                            double memory) {
  const double particles = count(spacing), most = mostParticles(memory);
  if (particles <= most) return std::nullopt;
  const bool byMemory = most < kLargestCount;
  constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
  std::string text = "expected a spacing that makes at most " + digits(most, 2) + " particles" +
                     (byMemory ? " (" + digits(memory / kGiB, 2) + " GiB are available)" : "") + ", found " +
                     digits(spacing, 6) + " m, which makes " + digits(particles, 2) +
                     (byMemory ? " (about " + digits(particles * kBytesPerParticle / kGiB, 2) + " GiB)" : "");
  if (const auto enough = most > 0 ? coarseEnough(count, spacing, most) : std::nullopt)
    text += "; a spacing of " + digits(*enough, 2) + " m would do";
  return text;
}

std::optional<std::string> tooManyParticles(double particles, double spacing, double memory) {
  return tooManyParticles([=](double other) { return particles * std::pow(spacing / other, 3); }, spacing,
                          memory);
}

namespace {

/// Quotients of decimal numbers miss whole ones by what a double cannot hold.
constexpr double kStepRounding = 1e-9;

bool tooMany(double steps) {
  return !(steps <= kMostSteps * (1 + kStepRounding));
}

std::string ofSubsteps(const SolverParameters& solver) {
  return solver.substeps > 1 ? " in " + std::to_string(solver.substeps) + " substeps each" : "";
}

/// The latest time (s) by which there are at most so many particles; nothing when there are more from the
/// start.
std::optional<double> latestEnd(const Scene& scene, double until, double most) {
  double fits = 0, beyond = until;
  if (particleCount(scene, scene.particleSpacing, fits) > most) return std::nullopt;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (fits + beyond);
    (particleCount(scene, scene.particleSpacing, middle) > most ? beyond : fits) = middle;
  }
  return fits > 0 ? shownRoundedDown(fits) : 0;
}

}  // namespace

double fewestSteps(const SolverParameters& solver, double time) {
  return time / solver.timeStep * solver.substeps;
}

std::optional<std::string> tooShortStep(const SolverParameters& solver, double duration) {
  const double steps = fewestSteps(solver, duration);
  if (!tooMany(steps)) return std::nullopt;
  std::ostringstream text;
  text << "expected at least " << shownRoundedUp(duration * solver.substeps / kMostSteps) << " s"
       << ofSubsteps(solver) << ", with which the " << duration << " s of duration take at most "
       << kMostSteps << " steps, found " << solver.timeStep << " s, which takes " << steps
       << "; a shorter duration takes fewer, too";
  return text.str();
}

std::optional<std::string> tooLateAnEnd(const Scene& scene, double until, double memory) {
  std::ostringstream text;
  if (const double steps = fewestSteps(scene.solver, until); tooMany(steps)) {
    text << "expected at most "
         << shownRoundedDown(kMostSteps * scene.solver.timeStep / scene.solver.substeps) << " s, "
         << kMostSteps << " steps of " << scene.solver.timeStep << " s" << ofSubsteps(scene.solver)
         << ", found " << until << " s, which takes " << steps << "; a longer time_step takes fewer";
    return text.str();
  }
  // What drains take nobody knows beforehand: there emitters end where memory does, and say so.
  const double counted = scene.drains.empty() ? until : 0;
  const double particles = particleCount(scene, scene.particleSpacing, counted), most = mostParticles(memory);
  if (particles <= most) return std::nullopt;
  text << "expected an end by which there are at most " << most << " particles, found " << until
       << " s, by which emitters make them " << particles;
  if (const std::optional<double> latest = latestEnd(scene, until, most))
    text << "; an end of " << *latest << " s would do, and so would fewer \"particles\" of the emitters";
  text << "; a larger particle_spacing makes fewer";
  return text.str();
}

void requireReachable(const Scene& scene, double until, const std::string& option) {
  if (const auto fault = tooLateAnEnd(scene, until, availableMemory())) throw InputError(option, *fault);
}

}  // namespace migiwa
