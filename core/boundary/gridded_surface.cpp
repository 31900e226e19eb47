#include "core/boundary/gridded_surface.h"

#include <cmath>

#include "core/boundary/spline_fit.h"

namespace migiwa {

namespace {

/// Memory that a grid may take (bytes), for each of the two arrays.
constexpr double kMostBytes = 512.0 * 1024 * 1024;
/// Part of the margin up to which a point is projected by the grid. Deeper ones may be nearer to another side
/// than the splines tell.
constexpr float kShallow = 0.25F;

using Grid = SplineGrid<1>;
using Row = Eigen::Array<float, 4, 1>;

}  // namespace

GriddedSurface::GriddedSurface(std::shared_ptr<const Surface> shape, float supportRadius, ThreadPool& pool)
    : shape_(std::move(shape)), reach_(kReach * supportRadius) {
  motion = shape_->motion;
  grid_.cell = supportRadius / kCellsPerSupport;
  inverseCell_ = 1 / grid_.cell;
  const Bounds region = shape_->bounds().grown(static_cast<double>(reach_));
  grid_.origin = region.min.cast<float>();
  for (int axis = 0; axis < 3; ++axis)
    grid_.size[static_cast<std::size_t>(axis)] =
        static_cast<std::int32_t>(region.size()[axis] / static_cast<double>(grid_.blockEdge())) + 1;
  const auto width = static_cast<std::size_t>(grid_.size[0]),
             height = static_cast<std::size_t>(grid_.size[1]);
  const std::size_t rows = height * static_cast<std::size_t>(grid_.size[2]);
  // The last one stands for all around the grid.
  grid_.blocks.resize(width * rows + 1);
  least_.resize(grid_.blocks.size());
  const float half = 0.5F * grid_.blockEdge(), around = std::sqrt(3.0F) * half;
  constexpr std::int32_t kUsed = 0;
  const auto take = [&](std::size_t place, float distance) {
    least_[place] = distance - around;
    grid_.blocks[place] = distance >= reach_ + around          ? Grid::kFar
                          : distance <= -(grid_.cell + around) ? Grid::kElsewhere
                                                               : kUsed;
  };
  Vec3f ignored;
  take(width * rows, std::copysign(2 * (reach_ + around), shape_->distance(grid_.origin, ignored)));
  pool.run(rows, [&](std::size_t row) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t y = row % height, z = row / height;
      const Vec3f index(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
      Vec3f normal;
      take(row * width + x,
           shape_->distance(grid_.origin + grid_.blockEdge() * index + Vec3f::Constant(half), normal));
    }
  });
  std::int32_t used = 0;
  for (std::int32_t& block : grid_.blocks)
    if (block == kUsed) block = used++;
  if (static_cast<double>(used) * Grid::kBlockFloats * sizeof(float) > kMostBytes) {
    grid_.blocks.assign(grid_.blocks.size(), Grid::kElsewhere);
    least_.assign(least_.size(), -reach_);
    return;
  }
  fitSplines<1>(grid_, BlockLayout(grid_.size, grid_.blocks), pool,
                [&](const BlockPlace& place, BlockValues<1>& values) {
                  Vec3f normal;
                  for (std::size_t node = 0; node < values.size(); ++node)
                    values[node][0] =
                        shape_->distance(grid_.origin + grid_.cell * nodeIndex(place, node), normal);
                });
}

GriddedSurface::Place GriddedSurface::placeOf(const Vec3f& p) const {
  Place place;
  const Eigen::Array3f at = (p - grid_.origin).array() * inverseCell_;
  std::size_t stride = 1, nodeStride = 1;
  place.block = place.node = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto size = static_cast<std::size_t>(grid_.size[static_cast<std::size_t>(axis)]);
    if (!(at[axis] >= 0 && at[axis] < static_cast<float>(size * Grid::kCells))) {
      place.block = grid_.blocks.size() - 1;
      return place;
    }
    const auto cell = static_cast<std::size_t>(at[axis]);
    place.within[axis] = at[axis] - static_cast<float>(cell);
    place.block += stride * (cell / Grid::kCells);
    place.node += nodeStride * (cell % Grid::kCells);
    stride *= size;
    nodeStride *= Grid::kNodes;
  }
  return place;
}

float GriddedSurface::interpolate(const Place& place, Vec3f& normal) const {
  const std::size_t first =
      static_cast<std::size_t>(grid_.blocks[place.block]) * Grid::kBlockFloats + place.node;
  const SplineWeights x(place.within.x()), y(place.within.y()), z(place.within.z());
  Row value = Row::Zero(), alongY = Row::Zero(), alongZ = Row::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    Row flat = Row::Zero(), steep = Row::Zero();
    for (std::size_t j = 0; j < 4; ++j) {
      const Row row = Eigen::Map<const Row>(
          &grid_.coefficients[first + (k * Grid::kNodes + j) * std::size_t{Grid::kNodes}]);
      flat += y.value[j] * row;
      steep += y.slope[j] * row;
    }
    value += z.value[k] * flat;
    alongY += z.value[k] * steep;
    alongZ += z.slope[k] * flat;
  }
  const Row along = Eigen::Map<const Row>(x.value), across = Eigen::Map<const Row>(x.slope);
  normal = Vec3f((across * value).sum(), (along * alongY).sum(), (along * alongZ).sum());
  normal /= std::max(normal.norm(), 1e-6F * grid_.cell);
  return (along * value).sum();
}

float GriddedSurface::distance(const Vec3f& p, Vec3f& normal) const {
  const Place place = placeOf(p);
  const std::int32_t block = grid_.blocks[place.block];
  if (block >= 0) return interpolate(place, normal);
  if (block == Grid::kElsewhere) return shape_->distance(p, normal);
  normal = Vec3f::UnitY();
  return reach_;
}

bool GriddedSurface::project(Vec3f& p, float margin) const {
  constexpr int kRounds = 8;
  const float rounding = 1e-4F * margin;
  bool moved = false;
  Vec3f before = p;
  for (int round = 0; round < kRounds; ++round) {
    const Place place = placeOf(p);
    if (least_[place.block] >= margin) return moved;
    if (grid_.blocks[place.block] < 0) return shape_->project(p, margin) || moved;
    Vec3f normal;
    const float distance = interpolate(place, normal), missing = margin - distance;
    if (missing <= rounding) return moved;
    if (distance < kShallow * margin && round == 0) return shape_->project(p, margin);
    before = p;
    p += missing * normal;
    moved = true;
  }
  // To and fro between two parts of the wall: midway.
  p = 0.5F * (before + p);
  return true;
}

bool GriddedSurface::crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const {
  // No wall is nearer than the way is long: nothing to cross.
  const float length = (to - from).norm();
  const Place place = placeOf(from);
  if (least_[place.block] >= length) return false;
  Vec3f ignored;
  if (grid_.blocks[place.block] >= 0 && interpolate(place, ignored) >= 1.02F * length) return false;
  return shape_->crosses(from, to, normal, entry);
}

std::vector<std::shared_ptr<const Surface>> withDistanceGrids(
    const std::vector<std::shared_ptr<const Surface>>& surfaces, float supportRadius, ThreadPool& pool) {
  constexpr double kMostBlocks = kMostBytes / sizeof(std::int32_t);
  std::vector<std::shared_ptr<const Surface>> result;
  for (const auto& surface : surfaces) {
    const double edge = Grid::kCells * static_cast<double>(supportRadius) /
                        static_cast<double>(GriddedSurface::kCellsPerSupport);
    const bool fits = ((surface->bounds().size() / edge).array() + 6).prod() < kMostBlocks;
    result.push_back(surface->costlyDistance() && fits
                         ? std::make_shared<const GriddedSurface>(surface, supportRadius, pool)
                         : surface);
  }
  return result;
}

}  // namespace migiwa
