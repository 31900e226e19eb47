// Neighbours within the support radius, by a counting sort over a uniform grid. Particles are reordered along
// the grid first, so that neighbours in space are neighbours in memory. The order depends on positions alone,
// never on the number of threads.
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
  /// Sorts: afterwards order()[k] is the index of the particle that comes k-th along the grid. Positions must
  /// be finite.
  void build(std::span<const Float4> positions, float cellSize, ThreadPool& pool);
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// First and one past the last sorted place of the cells x0..x1 in row (y, z); empty outside the grid.
  std::pair<std::uint32_t, std::uint32_t> row(int x0, int x1, int y, int z) const;
  int cellX(float x) const { return cell(x - originX_, 0); }
  int cellY(float y) const { return cell(y - originY_, 1); }
  int cellZ(float z) const { return cell(z - originZ_, 2); }

 private:
  int cell(float offset, int axis) const;

  float originX_ = 0, originY_ = 0, originZ_ = 0;
  float inverseCell_ = 1;
  int size_[3] = {1, 1, 1};
  std::vector<std::uint32_t> start_;  ///< of each cell, and one past the last
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> keys_;
};

/// Lists of neighbours j != i with |x_i - x_j| < radius, for particles that are already in grid order.
class NeighbourLists {
 public:
  void build(const CellGrid& grid, std::span<const Float4> positions, float radius, ThreadPool& pool);
  std::span<const std::uint32_t> of(std::size_t i) const {
    const std::vector<std::uint32_t>& chunk = chunks_[i / kChunk];
    return std::span(chunk).subspan(start_[i], count_[i]);
  }
  std::span<const std::uint32_t> counts() const { return count_; }
  std::size_t bytes() const;

 private:
  std::vector<std::vector<std::uint32_t>> chunks_;  ///< one list a chunk: chunks are filled independently
  std::vector<std::uint32_t> start_;                ///< of each particle's list within its chunk's
  std::vector<std::uint32_t> count_;
};

}  // namespace migiwa
