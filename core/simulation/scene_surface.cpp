#include "core/simulation/scene_surface.h"

#include <utility>

#include "core/base/progress.h"
#include "core/walls/gridded.h"

namespace migiwa {

namespace {

Boundary preparedWalls(const Scene& scene, ThreadPool& pool) {
  const Activity activity("measuring distances to the walls");
  const auto support = static_cast<float>(scene.supportRadius());
  Boundary walls(
      withDistanceGrids(scene.surfaces, support, pool, scene.file.string() + ":/boundary/surfaces"));
  walls.indexWalls(support);
  return walls;
}

}  // namespace

SceneSurface::SceneSurface(const Scene& scene, SurfaceOptions options, ThreadPool& pool)
    : options_(std::move(options)),
      pool_(pool),
      spacing_(static_cast<float>(scene.particleSpacing)),
      support_(static_cast<float>(scene.supportRadius())),
      kernel_(scene.solver.kernel),
      boundary_(preparedWalls(scene, pool)) {
  if (boundary_.empty()) return;
  gamma_ =
      makeGammaMethod(scene.boundary.gammaMethod,
                      {boundary_, kernel_, support_, scene.boundary.directions, scene.boundary.samples,
                       scene.bounds(), &pool, scene.file.string() + ":/boundary/gamma/method", spacing_});
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

}  // namespace migiwa
