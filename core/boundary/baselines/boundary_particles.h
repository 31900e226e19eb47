// Boundary particles: points spread over the walls of a scene, one layer thick, each with the volume that it
// stands for (Akinci et al. 2012, "Versatile Rigid-Fluid Coupling for Incompressible SPH", section 3.1).
#pragma once

#include <string>
#include <vector>

#include "core/base/bounds.h"
#include "core/base/parallel.h"
#include "core/boundary/boundary.h"
#include "core/sph/cell_grid.h"
#include "core/sph/kernel_type.h"

namespace migiwa {

/// Points `depth` (m) behind the walls, within `region`: no two nearer to each other than about a `spacing`
/// (m), and no place of that layer farther than that from one of them. In parts of a solid that are too thin
/// for that depth they lie midway. Flat walls along the axes have a square lattice of them. The same for any
/// number of threads. Throws InputError, at `place`, when there would be too many.
std::vector<Vec3f> sampleWalls(const Boundary& boundary, const Bounds& region, float spacing, float depth,
                               ThreadPool& pool, const std::string& place);

/// Boundary particles, to be found from where a fluid particle is.
class BoundaryParticles {
 public:
  /// Akinci Eqs. 4 and 5: Psi_b / rho0 = V_b = 1 / sum_k W_bk over all boundary particles k in reach, b
  /// itself included.
  BoundaryParticles(const std::vector<Vec3f>& places, KernelType kernel, float supportRadius,
                    ThreadPool& pool);

  /// xyz: place (m); w: volume over the support radius cubed.
  std::span<const Float4> particles() const { return particles_; }

  /// Calls body(offset, q, volume) for the boundary particles within the support radius of p: offset from
  /// there to p and its length, both over the support radius.
  template <class Body>
  void around(const Vec3f& p, const Body& body) const {
    const CellGrid::Cell cell = grid_.cellOf(Float4(p));
    for (int row = 0; row < 9; ++row) {
      const auto [from, to] = grid_.row(cell.x - 1, cell.x + 1, cell.y + row % 3 - 1, cell.z + row / 3 - 1);
      for (std::uint32_t k = from; k < to; ++k) {
        const Vec3f offset = inverseSupport_ * (p - particles_[k].xyz());
        const float squared = offset.squaredNorm();
        if (squared < 1) body(offset, std::sqrt(squared), particles_[k].w);
      }
    }
  }

 private:
  float inverseSupport_;
  CellGrid grid_;
  std::vector<Float4> particles_;  ///< in the order of the grid
};

}  // namespace migiwa
