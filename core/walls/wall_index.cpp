#include "core/walls/wall_index.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace migiwa {

namespace {

/// Up to so many walls are asked one by one.
constexpr std::size_t kFew = 8;
/// Cells along the reach, if they are not more than kMostCells in all.
constexpr float kCellsPerReach = 2;
constexpr double kMostCells = 2e6;

float slopeOf(const Surface& wall) {
  return wall.exact() != nullptr ? kSteepestDistance : kExactSlope;
}

}  // namespace

WallIndex::WallIndex(const std::vector<const Surface*>& walls) : all_(walls.size()) {
  std::iota(all_.begin(), all_.end(), 0U);
  std::vector<UprightBlock> blocks;
  for (const Surface* wall : walls)
    if (const UprightBlock* block = wall->uprightBlock()) blocks.push_back(*block);
  blocks_ = std::make_shared<const std::vector<UprightBlock>>(std::move(blocks));
  const UprightBlock* next = blocks_->data();
  for (const Surface* wall : walls)
    walls_.push_back({wall, wall->uprightBlock() != nullptr ? next++ : nullptr, wall->uprightVessel()});
}

WallIndex::WallIndex(const std::vector<const Surface*>& walls, float reach, bool nearestToo)
    : WallIndex(walls) {
  reach_ = reach;
  if (walls_.size() <= kFew) return;
  Bounds bounds;
  for (const Surface* wall : walls) bounds.include(wall->bounds());
  if (bounds.empty()) return;
  bounds = bounds.grown(2 * static_cast<double>(reach));
  const Vec3d extent = bounds.size();
  const double edge =
      std::max(static_cast<double>(reach / kCellsPerReach), portable::cbrt(extent.prod() / kMostCells));
  cell_ = static_cast<float>(edge);
  inverseCell_ = 1 / cell_;
  origin_ = bounds.min.cast<float>();
  size_ = (extent / edge).array().floor().cast<int>() + 1;
  end_ = size_.cast<float>();
  cells_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                static_cast<std::size_t>(size_.z()));
  Known known;
  fill({Eigen::Vector3i::Zero(), size_}, all_, nearestToo, known);
  std::copy_if(all_.begin(), all_.end(), std::back_inserter(beyond_), [&](std::uint32_t k) {
    return nearestToo || !walls[k]->steadyDistance() || walls[k]->bounds().empty();
  });
}

void WallIndex::fill(const Block& block, const List& candidates, bool nearestToo, Known& known) {
  const Vec3f low = origin_ + cell_ * block.low.cast<float>(),
              high = origin_ + cell_ * block.high.cast<float>();
  const Vec3f middle = 0.5F * (low + high);
  const float around = 0.5F * (high - low).norm();
  std::vector<float> least;  // that a point of the block can be from each
  least.reserve(candidates.size());
  float most = std::numeric_limits<float>::infinity();
  for (const std::uint32_t k : candidates) {
    const IndexedWall& wall = walls_[k];
    const float squared = wall.block != nullptr ? wall.block->squaredDistance(middle) : 0;
    if (!wall->steadyDistance()) {
      least.push_back(-std::numeric_limits<float>::infinity());
      continue;
    }
    Vec3f ignored;
    const float distance = squared > 0 ? std::sqrt(squared) : wall->distance(middle, ignored);
    const float change = slopeOf(*wall.surface) * around;
    least.push_back(distance - change);
    most = std::min(most, distance + change);
  }
  const auto within = [&](float reach) {
    const float wanted = nearestToo ? std::max(most, reach) : reach;
    List kept;
    for (std::size_t k = 0; k < candidates.size(); ++k)
      if (least[k] <= wanted) kept.push_back(candidates[k]);
    return kept;
  };
  const List kept = within(reach_);

  const Eigen::Vector3i size = block.high - block.low;
  int axis = 0;
  if (size.maxCoeff(&axis) > 1 && kept.size() > 1) {
    Block one = block, other = block;
    one.high[axis] = other.low[axis] = block.low[axis] + size[axis] / 2;
    fill(one, kept, nearestToo, known);
    fill(other, kept, nearestToo, known);
    return;
  }
  std::array<List, kLevels.size()> lists;
  for (std::size_t level = 0; level < kLevels.size(); ++level) lists[level] = within(kLevels[level] * reach_);
  const auto [entry, isNew] = known.try_emplace(std::move(lists), static_cast<std::uint32_t>(ranges_.size()));
  if (isNew) {
    Range& range = ranges_.emplace_back();
    range.begin = static_cast<std::uint32_t>(listed_.size());
    for (std::size_t level = 0; level < kLevels.size(); ++level) {
      const List& list = entry->first[level];
      range.counts[level] = static_cast<std::uint32_t>(list.size());
      listed_.insert(listed_.end(), list.begin(), list.end());
    }
  }
  for (int z = block.low.z(); z < block.high.z(); ++z)
    for (int y = block.low.y(); y < block.high.y(); ++y)
      for (int x = block.low.x(); x < block.high.x(); ++x)
        cells_[(static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(size_.x()) +
               static_cast<std::size_t>(x)] = entry->second;
}

}  // namespace migiwa
