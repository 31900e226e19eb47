// Fills a GammaGrid: gamma at its nodes, on both sides of the walls, then the coefficients of the splines
// through them. Eq. 6 is a convolution of the kernel with the fluid side's indicator, so all that is asked of
// the walls is their distance, on a lattice of a tenth of the support radius (fluid_lattice.h): the cost does
// not depend on what the walls are made of. Behind a solid that ends within the kernel fluid counts again.
#pragma once

#include <string>

#include "core/base/bounds.h"
#include "core/base/parallel.h"
#include "core/boundary/gamma/gamma_grid.h"

namespace migiwa {

struct BakeSettings {
  KernelType kernel;
  float supportRadius;  ///< (m)
  float cell;           ///< (m)
  Bounds region;        ///< what the grid covers (m)
  bool curvedOnly;      ///< leaves the places out that only planar walls reach
  std::string place;    ///< of the gamma method in the scene file, for errors
};

/// Memory that a grid may take (bytes).
inline constexpr double kMostGridBytes = 1024.0 * 1024 * 1024;

/// Blocks in the region, with coefficients or without.
double blocksIn(const BakeSettings& settings);
/// The grid without coefficients: which blocks get some. Throws InputError where they would take too much
/// memory.
GammaGrid layOut(const Boundary& boundary, const BakeSettings& settings, ThreadPool& pool);
void bake(const Boundary& boundary, const BakeSettings& settings, ThreadPool& pool, GammaGrid& grid);

}  // namespace migiwa
