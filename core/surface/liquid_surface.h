// The surface of a liquid from its particles and walls.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/gamma/gamma_method.h"
#include "core/sph/kernels.h"
#include "core/surface/mesh.h"
#include "core/walls/boundary.h"

namespace migiwa {

/// Particles of one moment; those at no finite place are left out. `velocities` may be empty: the mesh then has velocities of zero.
struct LiquidParticles {
  std::span<const Float4> positions;   ///< (m)
  std::span<const Float4> velocities;  ///< (m/s)
  float spacing = 0;                   ///< of particles at rest (m)
  float supportRadius = 0;             ///< of the kernel (m)
  KernelType kernel = KernelType::poly6;
};

/// The walls at the same moment. Without them, or where there are none, all of the surface is free.
struct LiquidWalls {
  const Boundary* boundary = nullptr;
  const GammaMethod* gamma =
      nullptr;  ///< of the particles' kernel and support radius; null only without walls
};

struct SurfaceOptions {
  double resolution = 0.5;          ///< cells of the grid over the particle spacing (range: [0.1, 2])
  int smoothing = 10;               ///< passes over the free surface (range: [0, 100])
  double smallest = 0;              ///< pieces of less than so many particles' volume are left out; 0: none
  std::string place{"resolution"};  ///< of the resolution, for errors
};

/// The mesh around the liquid, the same for any number of threads. Empty without particles. Throws InputError
/// at options.place where the grid has no room in this machine's memory.
SurfaceMesh liquidSurface(const LiquidParticles& particles, const LiquidWalls& walls,
                          const SurfaceOptions& options, ThreadPool& pool, StageTimes* times = nullptr);

/// Volume that a closed mesh encloses (m^3).
double enclosedVolume(const SurfaceMesh& mesh);

}  // namespace migiwa
