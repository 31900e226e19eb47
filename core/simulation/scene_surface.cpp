// What can be seen of a scene's liquid: particles in colours, its surface, fields of it on a plane.
#include "core/simulation/scene_surface.h"

#include <utility>

#include "core/base/progress.h"
#include "core/simulation/frame_view.h"
#include "core/simulation/gauges.h"
#include "core/simulation/scene_section.h"
#include "core/walls/gridded.h"

namespace migiwa {

ColorFieldInfo colorFieldInfo(ColorField field, double referenceSpeed, double restDensity) {
  switch (field) {
    case ColorField::density:
      return {"density ρ/ρ₀", "", 0.6, 1.2};
    case ColorField::speed:
      return {"speed |v|", "m/s", 0, referenceSpeed};
    case ColorField::gamma:
      return {"boundary correction γ", "", 0.4, 1};
    case ColorField::lambda:
      return {"multiplier λh²", "", -0.02, 0};
    case ColorField::neighbours:
      return {"neighbours", "", 0, 60};
    case ColorField::pressure:
      return {"pressure p", "kPa", 0, 1e-3 * 0.5 * restDensity * referenceSpeed * referenceSpeed};
  }
  return {};
}

void colorFieldValues(const FrameView& view, ColorField field, std::vector<float>& out) {
  switch (field) {
    case ColorField::density:
      out.assign(view.density.begin(), view.density.end());
      return;
    case ColorField::gamma:
      out.assign(view.gamma.begin(), view.gamma.end());
      return;
    case ColorField::lambda:
      out.assign(view.lambda.begin(), view.lambda.end());
      return;
    case ColorField::neighbours:
      out.resize(view.neighbours.size());
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(view.neighbours[i]);
      return;
    case ColorField::pressure:
      out.assign(view.positions.size(), 0);
      for (std::size_t i = 0; i < view.pressure.size(); ++i) out[i] = 1e-3F * view.pressure[i];
      return;
    case ColorField::speed:
      out.resize(view.velocities.size());
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = view.velocities[i].xyz().norm();
      return;
  }
}

Boundary wallsOf(const Scene& scene, ThreadPool& pool) {
  const Activity activity("measuring distances to the walls");
  const auto support = static_cast<float>(scene.supportRadius());
  Boundary walls(
      withDistanceGrids(scene.surfaces, support, pool, scene.file.string() + ":/boundary/surfaces"));
  walls.indexWalls(support);
  return walls;
}

SceneSurface::SceneSurface(const Scene& scene, SurfaceOptions options, ThreadPool& pool)
    : options_(std::move(options)),
      pool_(pool),
      spacing_(static_cast<float>(scene.particleSpacing)),
      support_(static_cast<float>(scene.supportRadius())),
      kernel_(scene.solver.kernel),
      boundary_(wallsOf(scene, pool)) {
  if (boundary_.empty()) return;
  gamma_ = makeGammaMethod(scene.boundary.gammaMethod, gammaContextOf(scene, boundary_, pool));
}

SurfaceMesh SceneSurface::mesh(std::span<const Float4> positions, std::span<const Float4> velocities,
                               double time, StageTimes* times) {
  if (boundary_.moves()) {
    boundary_.moveTo(time, time);
    gamma_.method->wallsMoved();
  }
  return liquidSurface({positions, velocities, spacing_, support_, kernel_},
                       {&boundary_, gamma_.method.get()}, options_, pool_, times);
}

std::vector<float> sectionValues(const FrameView& view, SectionField field) {
  std::vector<float> values;
  colorFieldValues(view,
                   field == SectionField::pressure ? ColorField::pressure
                   : field == SectionField::speed  ? ColorField::speed
                                                   : ColorField::density,
                   values);
  return values;
}

ColorFieldInfo sectionFieldInfo(SectionField field, double referenceSpeed, double restDensity) {
  const auto of = [&](ColorField color) { return colorFieldInfo(color, referenceSpeed, restDensity); };
  switch (field) {
    case SectionField::density:
      return of(ColorField::density);
    case SectionField::pressure:
      return of(ColorField::pressure);
    case SectionField::speed:
      return of(ColorField::speed);
    case SectionField::gamma:
      return of(ColorField::gamma);
    case SectionField::gammaError:
      return {"γ less its reference", "", -0.02, 0.02};
  }
  return {};
}

SceneSection::SceneSection(const Scene& scene, ThreadPool& pool)
    : pool_(pool),
      method_(methodOf(scene.particleSpacing, scene.solver, scene.boundary)),
      weight_(restingLattice(scene.solver.kernel, scene.solver.supportRatio).massRatio),
      boundary_(wallsOf(scene, pool)) {
  if (boundary_.empty()) return;
  gamma_ = makeGammaMethod(scene.boundary.gammaMethod, gammaContextOf(scene, boundary_, pool));
  reference_ = referenceGamma(gammaContextOf(scene, boundary_, pool));
}

SceneSection::Method SceneSection::methodOf(double spacing, const SolverParameters& solver,
                                            const BoundaryParameters& boundary) {
  return {boundary.gammaMethod, boundary.directions, boundary.samples, solver.kernel,
          static_cast<float>(solver.supportRatio * spacing)};
}

SectionRaster SceneSection::of(const SectionPlane& plane, SectionField field, SectionDivisor divisor,
                               std::span<const Float4> positions, std::span<const float> values,
                               double time) {
  if (boundary_.moves()) {
    boundary_.moveTo(time, time);
    gamma_.method->wallsMoved();
    reference_.method->wallsMoved();
  }
  const SectionFluid fluid{positions, values, weight_, method_.support, method_.kernel};
  const LiquidWalls walls{&boundary_, gamma_.method.get()};
  if (isInterpolated(field)) return section(plane, fluid, walls, divisor, pool_);
  SectionRaster raster = gammaSection(plane, fluid, walls, pool_);
  if (field == SectionField::gamma) return raster;
  const SectionRaster reference = gammaSection(plane, fluid, {&boundary_, reference_.method.get()}, pool_);
  for (std::size_t k = 0; k < raster.values.size(); ++k) raster.values[k] -= reference.values[k];
  return raster;
}

}  // namespace migiwa
