// Coefficients of a SplineGrid from values at its nodes.
#pragma once

#include <functional>

#include "core/base/parallel.h"
#include "core/boundary/spline_grid.h"

namespace migiwa {

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

}  // namespace migiwa
