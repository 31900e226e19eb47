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
  std::vector<std::int32_t> blocks;   ///< of every block, x fastest: its place in `coefficients`, or why none
  std::int32_t outside = kElsewhere;  ///< what holds around the grid
  std::vector<float> coefficients;    ///< kBlockFloats for each block that has some

  float blockEdge() const { return static_cast<float>(kCells) * cell; }

  /// Where a point lies.
  struct Place {
    std::size_t block;   ///< among blocks; their number: outside of the grid
    std::int32_t state;  ///< what `blocks` says of it, or `outside`
    std::int32_t node;   ///< first of the 4 x 4 x 4 about the cell, among the block's
    Vec3f within;        ///< the cell, in [0, 1)
  };

  Place placeOf(const Vec3f& p) const {
    const Vec3f at = (p - origin) * (1 / cell);
    Place place{0, outside, 0, Vec3f::Zero()};
    std::size_t stride = 1;
    std::int32_t nodeStride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t count = size[static_cast<std::size_t>(axis)];
      if (!(at[axis] >= 0 && at[axis] < static_cast<float>(count * kCells))) {
        place.block = blocks.size();
        return place;
      }
      const auto whole = static_cast<std::int32_t>(at[axis]);
      place.within[axis] = at[axis] - static_cast<float>(whole);
      place.block += stride * static_cast<std::size_t>(whole / kCells);
      place.node += nodeStride * (whole % kCells);
      stride *= static_cast<std::size_t>(count);
      nodeStride *= kNodes;
    }
    place.state = blocks[place.block];
    return place;
  }
  /// The first coefficient about the cell, in a block that has some.
  const float* about(const Place& place) const {
    return &coefficients[static_cast<std::size_t>(place.state) * kBlockFloats +
                         Channels * static_cast<std::size_t>(place.node)];
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
