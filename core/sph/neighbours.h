// The search for neighbours: particles sorted along a grid of cells, and lists of neighbours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"

namespace migiwa {

// A uniform grid that particles are sorted along by a counting sort, so that neighbours in space are
// neighbours in memory. The order depends on positions alone, never on the number of threads.

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

// Who is within the support radius of whom, listed for passes that take several neighbours at a time.

/// A list's byte offsets seen as indices.
class NeighbourIndices {
 public:
  explicit NeighbourIndices(std::span<const std::uint32_t> offsets) : offsets_(offsets) {}

  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = std::uint32_t;
    using difference_type = std::ptrdiff_t;
    using pointer = const std::uint32_t*;
    using reference = std::uint32_t;

    Iterator() = default;
    explicit Iterator(const std::uint32_t* offset) : offset_(offset) {}
    std::uint32_t operator*() const { return *offset_ / static_cast<std::uint32_t>(sizeof(Float4)); }
    Iterator& operator++() {
      ++offset_;
      return *this;
    }
    Iterator operator++(int) { return Iterator(offset_++); }
    bool operator==(const Iterator&) const = default;

   private:
    const std::uint32_t* offset_ = nullptr;
  };
  Iterator begin() const { return Iterator(offsets_.data()); }
  Iterator end() const { return Iterator(offsets_.data() + offsets_.size()); }
  std::size_t size() const { return offsets_.size(); }

 private:
  std::span<const std::uint32_t> offsets_;
};

/// Lists of neighbours j != i with |x_i - x_j| < radius, for particles that are already in grid order. A
/// neighbour is stored as the offset in bytes of its Float4, and every list is filled up to whole groups with
/// a particle that does not exist, the one after the last: passes over the neighbours need neither an index
/// computation nor a remainder loop. Arrays of Float4 that passes read by these offsets have that one more
/// element, at ghost().
class NeighbourLists {
 public:
  /// Neighbours that a pass takes at once.
  static constexpr std::size_t kGroup = 8;

  static constexpr std::size_t wholeGroups(std::size_t count) {
    return (count + kGroup - 1) / kGroup * kGroup;
  }

  void build(const CellGrid& grid, std::span<const Float4> positions, float radius, ThreadPool& pool);
  /// The same in borrowed memory: `scratch` has room for the particles, and kScratchExtra more.
  void build(const CellGrid& grid, std::span<const Float4> positions, float radius, std::span<Float4> scratch,
             ThreadPool& pool);
  static constexpr std::size_t kScratchExtra = 2 * kGroup;

  /// Byte offsets of the neighbours of i, filled up to whole groups.
  std::span<const std::uint32_t> groups(std::size_t i) const {
    const std::uint32_t* list = chunks_[i / kChunk].offsets.get() + start_[i];
    return {list, wholeGroups(count_[i])};
  }
  /// Indices of the neighbours of i.
  NeighbourIndices of(std::size_t i) const { return NeighbourIndices(groups(i).first(count_[i])); }
  /// Keeps those neighbours j of i for which kept(j), asked in the order of the list. Lists of different
  /// particles can be thinned at once.
  template <class Kept>
  void keep(std::size_t i, Kept kept) {
    std::uint32_t* const list = chunks_[i / kChunk].offsets.get() + start_[i];
    const std::uint32_t count = count_[i];
    std::uint32_t left = 0;
    for (std::uint32_t k = 0; k < count; ++k)
      if (kept(list[k] / sizeof(Float4))) list[left++] = list[k];
    const auto ghost = static_cast<std::uint32_t>(count_.size() * sizeof(Float4));
    for (std::uint32_t k = left; k < count; ++k) list[k] = ghost;
    count_[i] = left;
  }
  /// A float for each of groups(i), in their order, for what a pass over the pairs leaves to others over the
  /// same lists. There is memory for them where makePairValues() was called since build().
  float* pairValues(std::size_t i) { return chunks_[i / kChunk].values[start_[i] / kGroup].lanes; }
  const float* pairValues(std::size_t i) const {
    return chunks_[i / kChunk].values[start_[i] / kGroup].lanes;
  }
  /// For the particles of a chunk of kChunk: those of several chunks can be made at once.
  void makePairValues(std::size_t chunk) { chunks_[chunk].makeValues(); }
  std::span<const std::uint32_t> counts() const { return count_; }
  /// Where the particle that fills up the lists is: out of reach of all others (m).
  const Float4& ghost() const { return ghost_; }
  std::size_t bytes() const;

 private:
  /// Of a vector's alignment.
  struct alignas(4 * kGroup) ValueGroup {
    float lanes[kGroup];
  };
  /// The lists of a fixed range of particles: ranges are filled independently.
  struct Chunk {
    std::unique_ptr<std::uint32_t[]> offsets;
    std::unique_ptr<ValueGroup[]> values;
    std::size_t capacity = 0, valueCapacity = 0;
    void assign(std::span<const std::uint32_t> lists);
    void makeValues();
  };
  std::vector<Chunk> chunks_;
  std::vector<std::uint32_t> start_;  ///< of each particle's list within its chunk's
  std::vector<std::uint32_t> count_;
  Float4 ghost_;
};

}  // namespace migiwa
