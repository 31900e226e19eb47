// gamma by directions at any point, in the fluid or not: the kernel's mass in all that is fluid along each
// ray, however often it goes in and out of the solid. What a grid is baked from.
#pragma once

#include <array>
#include <vector>

#include "core/boundary/boundary.h"
#include "core/sph/kernel_type.h"

namespace migiwa {

class VolumeRays {
 public:
  VolumeRays(const Boundary& boundary, KernelType kernel, float supportRadius, int directions);

  struct Scratch {
    std::vector<const Surface*> near;
    std::vector<WallPiece> pieces;
    std::vector<std::vector<RayCrossings>> crossings;  ///< of each surface in reach
    std::vector<char> inSolid;                         ///< whether the point is in its solid
    std::vector<char> inside;                          ///< the same along a ray
    std::vector<std::pair<float, std::size_t>> changes;
    std::vector<float> plus, minus;
  };

  /// gamma for the density kernel, and for the kernel of the pair gradients.
  std::array<float, 2> at(const Vec3f& p, Scratch& scratch) const;

 private:
  void addFluidOf(std::size_t ray, std::size_t surfaces, Scratch& scratch) const;

  const Boundary& boundary_;
  KernelType kernel_, pairKernel_;
  float support_;
  Directions directions_;
};

}  // namespace migiwa
