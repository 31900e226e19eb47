#include "core/walls/wall_index.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace migiwa {

namespace {

/// Up to so many walls are asked one by one.
constexpr std::size_t kFew = 8;
/// Cells along the reach, if they are not more than kMostCells in all.
constexpr float kCellsPerReach = 2;
constexpr double kMostCells = 2e6;
/// How much faster than a point a distance may change: those from a grid are a little too steep in places.
constexpr float kExactSlope = 1.001F, kGriddedSlope = 1.5F;

float slopeOf(const Surface& wall) {
  return wall.exact() != nullptr ? kGriddedSlope : kExactSlope;
}

}  // namespace

WallIndex::WallIndex(std::vector<const Surface*> walls, float reach, bool nearestToo)
    : walls_(std::move(walls)), reach_(reach) {
  if (walls_.size() <= kFew) return;
  Bounds bounds;
  for (const Surface* wall : walls_) bounds.include(wall->bounds());
  if (bounds.empty()) return;
  bounds = bounds.grown(2 * static_cast<double>(reach));
  const Vec3d extent = bounds.size();
  const double edge =
      std::max(static_cast<double>(reach / kCellsPerReach), portable::cbrt(extent.prod() / kMostCells));
  cell_ = static_cast<float>(edge);
  inverseCell_ = 1 / cell_;
  origin_ = bounds.min.cast<float>();
  size_ = (extent / edge).array().floor().cast<int>() + 1;
  cells_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                static_cast<std::size_t>(size_.z()));
  fill({Eigen::Vector3i::Zero(), size_}, walls_, nearestToo);
  std::copy_if(walls_.begin(), walls_.end(), std::back_inserter(beyond_), [&](const Surface* wall) {
    return nearestToo || !wall->steadyDistance() || wall->bounds().empty();
  });
}

void WallIndex::fill(const Block& block, const std::vector<const Surface*>& candidates, bool nearestToo) {
  const Vec3f low = origin_ + cell_ * block.low.cast<float>(),
              high = origin_ + cell_ * block.high.cast<float>();
  const Vec3f middle = 0.5F * (low + high);
  const float around = 0.5F * (high - low).norm();
  std::vector<float> least;  // that a point of the block can be from each
  float most = std::numeric_limits<float>::infinity();
  for (const Surface* wall : candidates) {
    if (!wall->steadyDistance()) {
      least.push_back(-std::numeric_limits<float>::infinity());
      continue;
    }
    Vec3f ignored;
    const float distance = wall->distance(middle, ignored), change = slopeOf(*wall) * around;
    least.push_back(distance - change);
    most = std::min(most, distance + change);
  }
  const auto within = [&](float reach) {
    const float wanted = nearestToo ? std::max(most, reach) : reach;
    std::vector<const Surface*> kept;
    for (std::size_t k = 0; k < candidates.size(); ++k)
      if (least[k] <= wanted) kept.push_back(candidates[k]);
    return kept;
  };
  const std::vector<const Surface*> kept = within(reach_);

  const Eigen::Vector3i size = block.high - block.low;
  int axis = 0;
  if (size.maxCoeff(&axis) > 1 && kept.size() > 1) {
    Block one = block, other = block;
    one.high[axis] = other.low[axis] = block.low[axis] + size[axis] / 2;
    fill(one, kept, nearestToo);
    fill(other, kept, nearestToo);
    return;
  }
  Range range;
  range.begin = static_cast<std::uint32_t>(listed_.size());
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    const std::vector<const Surface*> some = within(kLevels[level] * reach_);
    range.counts[level] = static_cast<std::uint32_t>(some.size());
    listed_.insert(listed_.end(), some.begin(), some.end());
  }
  for (int z = block.low.z(); z < block.high.z(); ++z)
    for (int y = block.low.y(); y < block.high.y(); ++y)
      for (int x = block.low.x(); x < block.high.x(); ++x)
        cells_[(static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(size_.x()) +
               static_cast<std::size_t>(x)] = range;
}

std::span<const Surface* const> WallIndex::near(const Vec3f& p, float reach) const {
  if (cells_.empty()) return walls_;
  const Vec3f at = inverseCell_ * (p - origin_);
  if (!((at.array() >= 0).all() && (at.array() < size_.cast<float>().array()).all())) return beyond_;
  const Eigen::Vector3i cell = at.cast<int>();
  const Range& range = cells_[(static_cast<std::size_t>(cell.z()) * static_cast<std::size_t>(size_.y()) +
                               static_cast<std::size_t>(cell.y())) *
                                  static_cast<std::size_t>(size_.x()) +
                              static_cast<std::size_t>(cell.x())];
  std::size_t level = 0, begin = range.begin;
  while (level + 1 < kLevels.size() && reach > kLevels[level] * reach_) begin += range.counts[level++];
  return std::span(listed_).subspan(begin, range.counts[level]);
}

}  // namespace migiwa
