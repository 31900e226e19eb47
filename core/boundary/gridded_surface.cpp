#include "core/boundary/gridded_surface.h"

#include <cmath>

#include "core/base/available_memory.h"
#include "core/boundary/spline_fit.h"
#include "core/boundary/spline_value.h"

namespace migiwa {

namespace {

/// Memory that a grid may take (bytes), for each of the two arrays.
constexpr double kMostBytes = 512.0 * 1024 * 1024;
constexpr const char* kWhat = "a grid of wall distances";
/// What fitting the splines takes in all, over their coefficients.
constexpr double kFittingOverGrid = 3;
/// Part of the margin up to which a point is projected by the grid. Deeper ones may be nearer to another side
/// than the splines tell.
constexpr float kShallow = 0.25F;

}  // namespace

GriddedSurface::GriddedSurface(std::shared_ptr<const Surface> shape, float supportRadius, ThreadPool& pool,
                               const std::string& scenePlace)
    : shape_(std::move(shape)), reach_(kReach * supportRadius) {
  motion = shape_->motion;
  grid_.cell = supportRadius / kCellsPerSupport;
  const Bounds region = shape_->bounds().grown(static_cast<double>(reach_));
  grid_.origin = region.min.cast<float>();
  for (int axis = 0; axis < 3; ++axis)
    grid_.size[static_cast<std::size_t>(axis)] =
        static_cast<std::int32_t>(region.size()[axis] / static_cast<double>(grid_.blockEdge())) + 1;
  const auto width = static_cast<std::size_t>(grid_.size[0]),
             height = static_cast<std::size_t>(grid_.size[1]);
  const std::size_t rows = height * static_cast<std::size_t>(grid_.size[2]);
  // The blocks, their least distances and the splines' own index of them.
  requireMemory(3 * sizeof(float) * static_cast<double>(width * rows), kWhat, scenePlace);
  grid_.blocks.resize(width * rows);
  least_.resize(grid_.blocks.size() + 1);  // the last for all around the grid
  const float half = 0.5F * grid_.blockEdge(), around = std::sqrt(3.0F) * half;
  constexpr std::int32_t kUsed = 0;
  const auto take = [&](std::size_t place, float distance) {
    least_[place] = distance - around;
    return distance >= reach_ + around          ? Grid::kFar
           : distance <= -(grid_.cell + around) ? Grid::kElsewhere
                                                : kUsed;
  };
  Vec3f ignored;
  grid_.outside =
      take(width * rows, std::copysign(2 * (reach_ + around), shape_->distance(grid_.origin, ignored)));
  pool.run(rows, [&](std::size_t row) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t y = row % height, z = row / height;
      const Vec3f index(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
      Vec3f normal;
      grid_.blocks[row * width + x] =
          take(row * width + x,
               shape_->distance(grid_.origin + grid_.blockEdge() * index + Vec3f::Constant(half), normal));
    }
  });
  std::int32_t used = 0;
  for (std::int32_t& block : grid_.blocks)
    if (block == kUsed) block = used++;
  const double bytes = static_cast<double>(used) * Grid::kBlockFloats * sizeof(float);
  if (bytes > kMostBytes) {
    grid_.blocks.assign(grid_.blocks.size(), Grid::kElsewhere);
    grid_.outside = Grid::kElsewhere;
    least_.assign(least_.size(), -reach_);
    return;
  }
  requireMemory(kFittingOverGrid * bytes, kWhat, scenePlace);
  fitSplines<1>(grid_, BlockLayout(grid_.size, grid_.blocks), pool,
                [&](const BlockPlace& place, BlockValues<1>& values) {
                  Vec3f normal;
                  for (std::size_t node = 0; node < values.size(); ++node)
                    values[node][0] =
                        shape_->distance(grid_.origin + grid_.cell * nodeIndex(place, node), normal);
                });
}

float GriddedSurface::interpolate(const Grid::Place& place, Vec3f& normal) const {
  const Vec3f& within = place.within;
  const SplineValue spline = splineValue(grid_.about(place), within.x(), within.y(), within.z());
  normal = spline.gradient / std::max(spline.gradient.norm(), 1e-6F * grid_.cell);
  return spline.value;
}

float GriddedSurface::distance(const Vec3f& p, Vec3f& normal) const {
  const Grid::Place place = grid_.placeOf(p);
  if (place.state >= 0) return interpolate(place, normal);
  if (place.state == Grid::kElsewhere) return shape_->distance(p, normal);
  normal = Vec3f::UnitY();
  return reach_;
}

bool GriddedSurface::project(Vec3f& p, float margin) const {
  constexpr int kRounds = 8;
  const float rounding = 1e-4F * margin;
  bool moved = false;
  Vec3f before = p;
  for (int round = 0; round < kRounds; ++round) {
    const Grid::Place place = grid_.placeOf(p);
    if (least_[place.block] >= margin) return moved;
    if (place.state < 0) return shape_->project(p, margin) || moved;
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
  return !outOfReach(from, (to - from).norm()) && shape_->crosses(from, to, normal, entry);
}

void GriddedSurface::pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const {
  if (!outOfReach(p, reach)) shape_->pieces(p, reach, out);
}

bool GriddedSurface::outOfReach(const Vec3f& p, float reach) const {
  const Grid::Place place = grid_.placeOf(p);
  if (least_[place.block] >= reach) return true;
  Vec3f ignored;
  return place.state >= 0 && interpolate(place, ignored) >= 1.02F * reach + 0.02F * reach_;
}

std::vector<std::shared_ptr<const Surface>> withDistanceGrids(
    const std::vector<std::shared_ptr<const Surface>>& surfaces, float supportRadius, ThreadPool& pool,
    const std::string& place) {
  constexpr double kMostBlocks = kMostBytes / sizeof(std::int32_t);
  std::vector<std::shared_ptr<const Surface>> result;
  for (const auto& surface : surfaces) {
    const double edge = SplineGrid<1>::kCells * static_cast<double>(supportRadius) /
                        static_cast<double>(GriddedSurface::kCellsPerSupport);
    const bool fits = ((surface->bounds().size() / edge).array() + 6).prod() < kMostBlocks;
    result.push_back(surface->costlyDistance() && fits
                         ? std::make_shared<const GriddedSurface>(surface, supportRadius, pool, place)
                         : surface);
  }
  return result;
}

}  // namespace migiwa
