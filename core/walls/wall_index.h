// Which of many walls can matter at a place.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/walls/surface.h"

namespace migiwa {

// A grid whose cells know the walls near them, so that what a particle costs does not grow with the number of
// walls that are elsewhere. Walls that move, and those whose distances jump, are near everywhere.

class WallIndex {
 public:
  WallIndex() = default;
  /// All walls are near everywhere.
  explicit WallIndex(std::vector<const Surface*> walls) : walls_(std::move(walls)) {}
  /// near() has the walls that come nearer than `reach` (m) and, if `nearestToo`, the nearest of all however
  /// far it is. Few walls get no grid.
  WallIndex(std::vector<const Surface*> walls, float reach, bool nearestToo);

  bool empty() const { return walls_.empty(); }
  std::span<const Surface* const> all() const { return walls_; }
  float reach() const { return reach_; }
  /// In the order of all(), with some more than it must have.
  std::span<const Surface* const> near(const Vec3f& p) const { return near(p, reach_); }
  /// Those that come nearer than a reach (m) that is not above reach(): the same, or fewer.
  std::span<const Surface* const> near(const Vec3f& p, float reach) const;

 private:
  /// Parts of the reach that a cell has lists for.
  static constexpr std::array<float, 3> kLevels{0, 0.3F, 1};
  /// Lists of a cell, one after another.
  struct Range {
    std::uint32_t begin = 0;
    std::array<std::uint32_t, kLevels.size()> counts{};
  };
  /// Cells from `low` on, before `high`.
  struct Block {
    Eigen::Vector3i low, high;
  };
  void fill(const Block& block, const std::vector<const Surface*>& candidates, bool nearestToo);

  std::vector<const Surface*> walls_;
  std::vector<const Surface*> beyond_;  ///< near where the grid has no cells
  float reach_ = 0;
  Vec3f origin_ = Vec3f::Zero();
  float cell_ = 1, inverseCell_ = 1;
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<Range> cells_;            ///< x fastest; none: no grid
  std::vector<const Surface*> listed_;  ///< the cells' walls, one cell's after another's
};

}  // namespace migiwa
