// The surface of a scene's liquid: its walls and gamma, kept from frame to frame.
#pragma once

#include <span>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/scene.h"
#include "core/surface/liquid_surface.h"
#include "core/walls/boundary.h"

namespace migiwa {

/// The walls of a scene as a run meets them, with distance grids where those pay.
Boundary wallsOf(const Scene& scene, ThreadPool& pool);

class SceneSurface {
 public:
  /// Prepares the walls. Keeps a reference to the pool. Whatever the scene's handling of walls, the surface
  /// divides by gamma: where the water is, is one question, how it is pushed another.
  SceneSurface(const Scene& scene, SurfaceOptions options, ThreadPool& pool);

  /// The mesh around particles (m, relative to Scene::origin; m/s) with the walls where they are at `time`
  /// (s). `velocities` may be empty.
  SurfaceMesh mesh(std::span<const Float4> positions, std::span<const Float4> velocities, double time,
                   StageTimes* times = nullptr);

  const Boundary& boundary() const { return boundary_; }
  const SurfaceOptions& options() const { return options_; }

 private:
  SurfaceOptions options_;
  ThreadPool& pool_;
  float spacing_, support_;
  KernelType kernel_;
  Boundary boundary_;
  PickedGamma gamma_;
};

}  // namespace migiwa
