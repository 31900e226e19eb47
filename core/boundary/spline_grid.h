// Functions of space that matter near walls only, on a sparse grid: blocks of cells where a wall is near,
// tricubic B-splines in between, so values and their gradients belong together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/types.h"

namespace migiwa {

/// `Channels`: functions that are held side by side.
template <std::size_t Channels>
struct SplineGrid {
  /// Cells along a block, and coefficients: a cell needs one before it and two behind.
  static constexpr int kCells = 4, kNodes = kCells + 3;
  /// Floats of a block: for each node the coefficients of all channels, x fastest.
  static constexpr std::size_t kBlockFloats = Channels * kNodes * kNodes * kNodes;
  /// Blocks without coefficients: too far from every wall, or left to another method.
  static constexpr std::int32_t kFar = -1, kElsewhere = -2;

  Vec3f origin = Vec3f::Zero();        ///< first corner of the first block (m)
  float cell = 1;                      ///< (m)
  std::array<std::int32_t, 3> size{};  ///< blocks along x, y, z
  std::vector<std::int32_t> blocks;  ///< of every block, x fastest: its place in `coefficients`, or why none
  std::vector<float> coefficients;   ///< kBlockFloats for each block that has some

  float blockEdge() const { return static_cast<float>(kCells) * cell; }

  /// The block that holds p, kElsewhere outside the grid.
  std::int32_t blockAt(const Vec3f& p) const {
    const Vec3f at = (p - origin) / cell;
    std::size_t index = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const auto along = static_cast<std::size_t>(axis);
      if (!(at[axis] >= 0 && at[axis] < static_cast<float>(size[along] * kCells))) return kElsewhere;
      index = index * static_cast<std::size_t>(size[along]) + static_cast<std::size_t>(at[axis]) / kCells;
    }
    return blocks[index];
  }
};

/// Cubic B-spline weights of the four nodes about a place t in [0, 1) of a cell, and their derivatives.
struct SplineWeights {
  float value[4], slope[4];

  explicit SplineWeights(float t) {
    const float u = 1 - t, t2 = t * t, u2 = u * u;
    value[0] = u2 * u * (1.0F / 6);
    value[1] = 2.0F / 3 - t2 * (1 - 0.5F * t);
    value[2] = 2.0F / 3 - u2 * (1 - 0.5F * u);
    value[3] = t2 * t * (1.0F / 6);
    slope[0] = -0.5F * u2;
    slope[1] = t * (1.5F * t - 2);
    slope[2] = -u * (1.5F * u - 2);
    slope[3] = 0.5F * t2;
  }
};

}  // namespace migiwa
