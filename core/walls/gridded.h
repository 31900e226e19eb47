// Walls and functions of space on sparse grids of splines.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"
#include "core/walls/surface.h"

namespace migiwa {

// Functions of space that matter near walls only, on a sparse grid: blocks of cells where a wall is near,
// tricubic B-splines in between, so values and their gradients belong together.

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

// A wall whose distance is read from a grid: for shapes that take long to say how far they are, such as SLIM
// surfaces, asked by every particle near them several times a step. Everything else is the shape's own. The
// cost does not depend on what the shape is made of.

class GriddedSurface final : public StandIn {
  using Grid = SplineGrid<1>;

 public:
  /// Cells along a support radius, and support radii around the wall that have a grid.
  static constexpr float kCellsPerSupport = 5, kReach = 1.6F;

  /// Throws InputError at `scenePlace` where the grid has no room in memory.
  GriddedSurface(std::shared_ptr<const Surface> shape, float supportRadius, ThreadPool& pool,
                 const std::string& scenePlace = {});

  std::shared_ptr<const Surface> exact() const override { return shape_; }

  void describe(FieldVisitor&) override {}  // the shape itself was read before
  void describe(FieldWriter& visitor) const override { shape_->describe(visitor); }
  bool steadyDistance() const override { return !grid_.coefficients.empty(); }
  /// Within kReach of the wall, that of the splines: off by about 0.001 support radii where the wall is
  /// smooth and by 0.02 next to creases, which it rounds. Farther out in the fluid no more than kReach, and
  /// deep in the solid the shape's own.
  float distance(const Vec3f& p, Vec3f& normal) const override;
  /// That of the shape, and what the splines miss of its distance.
  float statedError(const Vec3f& p) const override;
  bool project(Vec3f& p, float margin) const override;
  bool hides(const Vec3f& from, const Vec3f& to) const override {
    return !outOfReach(from, (to - from).norm()) && shape_->hides(from, to);
  }
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override;

 private:
  /// The spline's value and unit gradient, in a block that has coefficients.
  float interpolate(const Grid::Place& place, Vec3f& normal) const;
  /// Whether the wall is certainly farther than `reach` from p.
  bool outOfReach(const Vec3f& p, float reach) const;

  Grid grid_;
  std::vector<float> least_;  ///< distance (m) that every point of a block has
  float reach_;
};

/// The surfaces, those with costly distances behind grids for this support radius (m). Where a grid would
/// take more than half a GiB the shape stays as it is. Throws InputError at `place` where a smaller one
/// has no room in this machine's memory.
std::vector<std::shared_ptr<const Surface>> withDistanceGrids(
    const std::vector<std::shared_ptr<const Surface>>& surfaces, float supportRadius, ThreadPool& pool,
    const std::string& place = {});

// Coefficients of a SplineGrid from values at its nodes.

/// The place of a block among the blocks of a grid; -1 and size are the ring about it.
using BlockPlace = std::array<std::int32_t, 3>;

/// The blocks of a grid that have coefficients, and those around them, which the splines need values of too.
class BlockLayout {
 public:
  BlockLayout(const std::array<std::int32_t, 3>& size, const std::vector<std::int32_t>& blocks);

  const std::vector<BlockPlace>& places() const { return places_; }
  /// The number of the block at a place; -1: not there.
  std::int32_t at(std::int32_t x, std::int32_t y, std::int32_t z) const;

 private:
  std::size_t indexOf(const BlockPlace& place) const;
  void addAround(const BlockPlace& center);

  std::array<std::int32_t, 3> size_{};
  std::vector<std::int32_t> index_;
  std::vector<BlockPlace> places_;
};

/// Values at the nodes of a block, x fastest.
template <std::size_t Channels>
using BlockValues =
    std::array<std::array<float, Channels>,
               std::size_t{SplineGrid<1>::kCells} * SplineGrid<1>::kCells * SplineGrid<1>::kCells>;

/// Index of a block's node, in cells from the grid's origin.
inline Vec3f nodeIndex(const BlockPlace& place, std::size_t node) {
  constexpr std::int32_t kCells = SplineGrid<1>::kCells;
  const auto along = [&](std::size_t axis, std::size_t within) {
    return static_cast<float>(place[axis] * kCells + static_cast<std::int32_t>(within));
  };
  return {along(0, node % kCells), along(1, node / kCells % kCells), along(2, node / kCells / kCells)};
}

/// Fills the coefficients of a grid whose blocks are laid out. `fill` gives the values of a block; it is
/// called from all threads.
template <std::size_t Channels>
void fitSplines(SplineGrid<Channels>& grid, const BlockLayout& layout, ThreadPool& pool,
                const std::function<void(const BlockPlace&, BlockValues<Channels>&)>& fill);

extern template void fitSplines<1>(SplineGrid<1>&, const BlockLayout&, ThreadPool&,
                                   const std::function<void(const BlockPlace&, BlockValues<1>&)>&);
extern template void fitSplines<2>(SplineGrid<2>&, const BlockLayout&, ThreadPool&,
                                   const std::function<void(const BlockPlace&, BlockValues<2>&)>&);

// Value and gradient of a tricubic B-spline of one channel, from the coefficients about its cell.

struct SplineValue {
  float value;
  Vec3f gradient;  ///< per cell
};

/// `first`: the first of the 4 x 4 x 4 coefficients about the cell, in a block of a SplineGrid<1>. x, y and
/// z: the place in the cell, in [0, 1).
SplineValue splineValue(const float* first, float x, float y, float z);

}  // namespace migiwa
