// Which of many walls can matter at a place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "core/walls/surface.h"
#include "core/walls/upright.h"

namespace migiwa {

/// Bounds for how fast the distance of a wall changes along a way: of true distances 1, but for rounding;
/// those of splines and of SLIM surfaces overshoot a little about creases.
inline constexpr float kExactSlope = 1.001F, kSteepestDistance = 1.5F;

/// A wall, and the upright block or vessel that it is: null for other walls.
struct IndexedWall {
  const Surface* surface = nullptr;
  const UprightBlock* block = nullptr;
  const UprightVessel* vessel = nullptr;

  /// As Surface::project().
  bool project(Vec3f& p, float margin) const {
    if (block != nullptr) return block->project(p, margin);
    return vessel != nullptr ? vessel->project(p, margin) : surface->project(p, margin);
  }

  operator const Surface*() const { return surface; }
  const Surface* operator->() const { return surface; }
};

/// Some of the walls of an index, in its order.
class NearWalls {
 public:
  NearWalls(const IndexedWall* walls, std::span<const std::uint32_t> listed)
      : walls_(walls), listed_(listed) {}

  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = IndexedWall;
    using difference_type = std::ptrdiff_t;
    using pointer = const IndexedWall*;
    using reference = const IndexedWall&;

    Iterator() = default;
    Iterator(const IndexedWall* walls, const std::uint32_t* at) : walls_(walls), at_(at) {}
    reference operator*() const { return walls_[*at_]; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    Iterator operator++(int) { return {walls_, at_++}; }
    bool operator==(const Iterator&) const = default;

   private:
    const IndexedWall* walls_ = nullptr;
    const std::uint32_t* at_ = nullptr;
  };
  Iterator begin() const { return {walls_, listed_.data()}; }
  Iterator end() const { return {walls_, listed_.data() + listed_.size()}; }
  std::size_t size() const { return listed_.size(); }
  bool empty() const { return listed_.empty(); }

 private:
  const IndexedWall* walls_;
  std::span<const std::uint32_t> listed_;
};

// A grid whose cells know the walls near them, so that what a particle costs does not grow with the number of
// walls that are elsewhere. Walls that move, and those whose distances jump, are near everywhere.

class WallIndex {
 public:
  WallIndex() = default;
  /// All walls are near everywhere.
  explicit WallIndex(const std::vector<const Surface*>& walls);
  /// near() has the walls that come nearer than `reach` (m) and, if `nearestToo`, the nearest of all however
  /// far it is. Few walls get no grid.
  WallIndex(const std::vector<const Surface*>& walls, float reach, bool nearestToo);

  bool empty() const { return walls_.empty(); }
  NearWalls all() const { return {walls_.data(), all_}; }
  float reach() const { return reach_; }
  /// In the order of all(), with some more than it must have.
  NearWalls near(const Vec3f& p) const { return near(p, reach_); }
  /// Those that come nearer than a reach (m) that is not above reach(): the same, or fewer.
  NearWalls near(const Vec3f& p, float reach) const {
    if (cells_.empty()) return all();
    const float x = inverseCell_ * (p.x() - origin_.x()), y = inverseCell_ * (p.y() - origin_.y()),
                z = inverseCell_ * (p.z() - origin_.z());
    if (!(x >= 0 && y >= 0 && z >= 0 && x < end_.x() && y < end_.y() && z < end_.z()))
      return {walls_.data(), beyond_};
    const std::size_t row =
        static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y);
    const Range& range =
        ranges_[cells_[row * static_cast<std::size_t>(size_.x()) + static_cast<std::size_t>(x)]];
    std::size_t level = 0, begin = range.begin;
    while (level + 1 < kLevels.size() && reach > kLevels[level] * reach_) begin += range.counts[level++];
    return {walls_.data(), std::span(listed_).subspan(begin, range.counts[level])};
  }

 private:
  /// Parts of the reach that a cell has lists for.
  static constexpr std::array<float, 3> kLevels{0, 0.3F, 1};
  using List = std::vector<std::uint32_t>;
  /// Lists of a cell, one after another; cells with the same lists share them.
  struct Range {
    std::uint32_t begin = 0;
    std::array<std::uint32_t, kLevels.size()> counts{};
  };
  /// Cells from `low` on, before `high`.
  struct Block {
    Eigen::Vector3i low, high;
  };
  using Known = std::map<std::array<List, kLevels.size()>, std::uint32_t>;

  void fill(const Block& block, const List& candidates, bool nearestToo, Known& known);

  std::vector<IndexedWall> walls_;
  /// Those that walls_ points to, side by side. Copies of the index share them.
  std::shared_ptr<const std::vector<UprightBlock>> blocks_;
  List all_, beyond_;  ///< beyond_: near where the grid has no cells
  float reach_ = 0;
  Vec3f origin_ = Vec3f::Zero();
  float cell_ = 1, inverseCell_ = 1;
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  Vec3f end_ = Vec3f::Zero();         ///< size_
  std::vector<std::uint32_t> cells_;  ///< place in ranges_, x fastest; none: no grid
  std::vector<Range> ranges_;
  List listed_;  ///< the ranges' walls, one range's after another's
};

}  // namespace migiwa
