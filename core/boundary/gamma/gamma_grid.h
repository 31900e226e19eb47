// gamma on a sparse grid about the walls: blocks of cells only where a wall is near, tricubic B-splines in
// between, for the density kernel and the kernel of the pair gradients. The gradients are those of the
// splines, so they belong to the gamma that is returned.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/boundary/gamma_method.h"

namespace migiwa {

struct GammaGrid {
  /// Cells along a block, and coefficients: a cell needs one before it and two behind.
  static constexpr int kCells = 4, kNodes = kCells + 3;
  /// Floats of a block: for each node the coefficients of both kernels, x fastest.
  static constexpr std::size_t kBlockFloats = std::size_t{2} * kNodes * kNodes * kNodes;
  /// Blocks without coefficients: too far from every wall, or left to another method.
  static constexpr std::int32_t kFar = -1, kElsewhere = -2;

  Vec3f origin = Vec3f::Zero();        ///< first corner of the first block (m)
  float cell = 1;                      ///< (m)
  std::array<std::int32_t, 3> size{};  ///< blocks along x, y, z
  std::vector<std::int32_t> blocks;  ///< of every block, x fastest: its place in `coefficients`, or why none
  std::vector<float> coefficients;   ///< kBlockFloats for each block that has some

  /// The block that holds p, kElsewhere outside the grid.
  std::int32_t blockAt(const Vec3f& p) const;
};

/// Interpolates at points that lie in blocks with coefficients: gamma and gradients, not the distance.
/// blocks[i] is blockAt(points[i]); points in other blocks are left alone.
void interpolate(const GammaGrid& grid, float supportRadius, std::span<const Float4> points,
                 std::span<const std::int32_t> blocks, std::span<GammaSample> out);

}  // namespace migiwa
