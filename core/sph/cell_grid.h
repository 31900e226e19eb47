// A uniform grid that particles are sorted along by a counting sort, so that neighbours in space are
// neighbours in memory. The order depends on positions alone, never on the number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/types.h"

namespace migiwa {

/// Uniform grid over the particles' bounding box; cells are at least `cellSize` wide, more where particles
/// are spread so thin that such cells would outnumber them.
class CellGrid {
 public:
  /// Sorts: afterwards order()[k] is the index of the particle that comes k-th along the grid. Particles
  /// whose place is not finite come to lie in the cells at the edge, and are neighbours of none.
  void build(std::span<const Float4> positions, float cellSize, ThreadPool& pool);
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// Sorted places [from, to).
  struct Places {
    std::uint32_t from = 0, to = 0;
  };
  struct Cell {
    int x, y, z;
  };
  Cell cellOf(const Float4& p) const {
    return {index(p.x - originX_, 0), index(p.y - originY_, 1), index(p.z - originZ_, 2)};
  }
  Places places(const Cell& cell) const { return row(cell.x, cell.x, cell.y, cell.z); }
  /// The places of the cells x0..x1 in row (y, z); empty outside the grid.
  Places row(int x0, int x1, int y, int z) const;
  /// How many particles the cell with the most of them has.
  std::uint32_t fullestCell() const { return fullest_; }
  /// The lowest corner of the particles' bounding box.
  Vec3f origin() const { return {originX_, originY_, originZ_}; }

 private:
  int index(float offset, int axis) const;

  float originX_ = 0, originY_ = 0, originZ_ = 0;
  float inverseCell_ = 1;
  int size_[3] = {1, 1, 1};
  std::uint32_t fullest_ = 0;
  std::vector<std::uint32_t> start_;  ///< of each cell, and one past the last
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> keys_;
};

}  // namespace migiwa
