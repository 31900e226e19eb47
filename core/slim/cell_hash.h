// The cells of an endless uniform grid that hold something, found by a hash of their coordinates: the same
// cost however large the grid is.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/types.h"

namespace migiwa {

struct CellCoordinates {
  std::int32_t x, y, z;
};

/// The cell along one axis that a coordinate, in edges of cells, lies in; the last one for all that is
/// farther than a whole number counts, and for what is no number.
inline std::int32_t cellAlong(float place) {
  constexpr float kLast = 1 << 30;
  return static_cast<std::int32_t>(std::fmin(std::fmax(std::floor(place), -kLast), kLast));
}

/// Coordinates in one number; exact for |coordinate| < 2^20.
inline std::uint64_t cellKey(const CellCoordinates& cell) {
  constexpr std::int64_t kHalf = std::int64_t{1} << 20;
  return static_cast<std::uint64_t>(cell.x + kHalf) | static_cast<std::uint64_t>(cell.y + kHalf) << 21 |
         static_cast<std::uint64_t>(cell.z + kHalf) << 42;
}

/// The range of entries that each occupied cell has in an array sorted by cell.
class CellHash {
 public:
  struct Range {
    std::uint32_t begin = 0, end = 0;
  };

  /// `sortedKeys[k]` is the cell of entry k.
  void build(const std::vector<std::uint64_t>& sortedKeys);
  /// Empty for a cell that holds nothing.
  Range find(std::uint64_t key) const {
    if (slots_.empty()) return {};
    for (std::size_t slot = hash(key) & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot].key == key) return slots_[slot].range;
      if (slots_[slot].key == kEmpty) return {};
    }
  }
  std::size_t cells() const { return cells_; }

 private:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = kEmpty;
    Range range;
  };
  static std::size_t hash(std::uint64_t key) {
    key *= 0x9E3779B97F4A7C15U;
    return static_cast<std::size_t>(key ^ key >> 32);
  }

  std::vector<Slot> slots_;
  std::size_t mask_ = 0, cells_ = 0;
};

}  // namespace migiwa
