#include "core/walls/gridded.h"

#include <cmath>

#include "core/base/files.h"
#include "core/walls/boundary.h"

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
    : reach_(kReach * supportRadius) {
  shape_ = std::move(shape);
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

float GriddedSurface::statedError(const Vec3f& p) const {
  Vec3f ignored;
  return shape_->statedError(p) + std::abs(shape_->distance(p, ignored) - distance(p, ignored));
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
  for (const auto& surface : wallsFor(surfaces, supportRadius)) {
    const double edge = SplineGrid<1>::kCells * static_cast<double>(supportRadius) /
                        static_cast<double>(GriddedSurface::kCellsPerSupport);
    const bool fits = ((surface->bounds().size() / edge).array() + 6).prod() < kMostBlocks;
    result.push_back(surface->costlyDistance() && fits
                         ? std::make_shared<const GriddedSurface>(surface, supportRadius, pool, place)
                         : surface);
  }
  return result;
}

namespace {

constexpr int kCells = SplineGrid<1>::kCells;

/// Calls take(number, value) for the nodes [-Before, kCells + Behind) about a block along each axis, x
/// fastest; null for those that are not there.
template <int Before, int Behind, std::size_t Channels, class Take>
void gather(const BlockLayout& layout, const std::vector<BlockValues<Channels>>& nodes,
            const BlockPlace& place, const Take& take) {
  std::size_t at = 0;
  for (int z = -Before; z < kCells + Behind; ++z) {
    for (int y = -Before; y < kCells + Behind; ++y) {
      for (int x = -Before; x < kCells + Behind; ++x, ++at) {
        const auto side = [](int k) { return k < 0 ? -1 : k >= kCells ? 1 : 0; };
        const auto within = [](int k) { return static_cast<std::size_t>((k + kCells) % kCells); };
        const std::int32_t block = layout.at(place[0] + side(x), place[1] + side(y), place[2] + side(z));
        const std::size_t node = (within(z) * kCells + within(y)) * kCells + within(x);
        take(at, block < 0 ? nullptr : &nodes[static_cast<std::size_t>(block)][node]);
      }
    }
  }
}

/// One step from values towards the coefficients of the spline through them: adds what the spline lacks.
template <std::size_t Channels>
void sharpen(const BlockLayout& layout, const std::vector<BlockValues<Channels>>& values,
             const std::vector<BlockValues<Channels>>& coefficients, std::size_t block,
             BlockValues<Channels>& out) {
  using Values = std::array<float, Channels>;
  constexpr std::size_t kSide = kCells + 2;
  std::array<Values, kSide * kSide * kSide> around{};
  std::array<bool, kSide * kSide * kSide> known{};
  gather<1, 1, Channels>(layout, coefficients, layout.places()[block],
                         [&](std::size_t at, const Values* value) {
                           known[at] = value != nullptr;
                           if (value != nullptr) around[at] = *value;
                         });
  constexpr std::array<float, 3> kSpline{1.0F / 6, 2.0F / 3, 1.0F / 6};
  std::size_t node = 0;
  for (std::size_t z = 0; z < kCells; ++z) {
    for (std::size_t y = 0; y < kCells; ++y) {
      for (std::size_t x = 0; x < kCells; ++x, ++node) {
        const Values own = coefficients[block][node];
        Values spline{};
        for (std::size_t k = 0; k < 27; ++k) {
          const std::size_t i = k % 3, j = k / 3 % 3, l = k / 9;
          const std::size_t at = ((z + l) * kSide + y + j) * kSide + x + i;
          const float weight = kSpline[i] * kSpline[j] * kSpline[l];
          for (std::size_t v = 0; v < Channels; ++v)
            spline[v] += weight * (known[at] ? around[at][v] : own[v]);
        }
        for (std::size_t v = 0; v < Channels; ++v) out[node][v] = own[v] + values[block][node][v] - spline[v];
      }
    }
  }
}

}  // namespace

BlockLayout::BlockLayout(const std::array<std::int32_t, 3>& size, const std::vector<std::int32_t>& blocks) {
  std::size_t all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = size[axis] + 2;
    all *= static_cast<std::size_t>(size_[axis]);
  }
  index_.assign(all, -1);
  std::size_t block = 0;
  for (std::int32_t z = 0; z < size[2]; ++z)
    for (std::int32_t y = 0; y < size[1]; ++y)
      for (std::int32_t x = 0; x < size[0]; ++x)
        if (blocks[block++] >= 0) addAround({x, y, z});
}

std::int32_t BlockLayout::at(std::int32_t x, std::int32_t y, std::int32_t z) const {
  if (x < -1 || y < -1 || z < -1 || x >= size_[0] - 1 || y >= size_[1] - 1 || z >= size_[2] - 1) return -1;
  return index_[indexOf({x, y, z})];
}

std::size_t BlockLayout::indexOf(const BlockPlace& place) const {
  return (static_cast<std::size_t>(place[2] + 1) * static_cast<std::size_t>(size_[1]) +
          static_cast<std::size_t>(place[1] + 1)) *
             static_cast<std::size_t>(size_[0]) +
         static_cast<std::size_t>(place[0] + 1);
}

void BlockLayout::addAround(const BlockPlace& center) {
  for (std::int32_t z = -1; z <= 1; ++z) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      for (std::int32_t x = -1; x <= 1; ++x) {
        const BlockPlace place{center[0] + x, center[1] + y, center[2] + z};
        std::int32_t& index = index_[indexOf(place)];
        if (index >= 0) continue;
        index = static_cast<std::int32_t>(places_.size());
        places_.push_back(place);
      }
    }
  }
}

template <std::size_t Channels>
void fitSplines(SplineGrid<Channels>& grid, const BlockLayout& layout, ThreadPool& pool,
                const std::function<void(const BlockPlace&, BlockValues<Channels>&)>& fill) {
  using Grid = SplineGrid<Channels>;
  const std::size_t count = layout.places().size();
  std::vector<BlockValues<Channels>> values(count);
  pool.run(count, [&](std::size_t block) { fill(layout.places()[block], values[block]); });

  // Each step leaves, of a wave of two support radii in the values, about a twentieth of the error.
  constexpr int kSteps = 4;
  std::vector<BlockValues<Channels>> coefficients = values, next(count);
  for (int step = 0; step < kSteps; ++step) {
    pool.run(count,
             [&](std::size_t block) { sharpen<Channels>(layout, values, coefficients, block, next[block]); });
    coefficients.swap(next);
  }

  std::vector<BlockPlace> used;
  std::size_t block = 0;
  for (std::int32_t z = 0; z < grid.size[2]; ++z)
    for (std::int32_t y = 0; y < grid.size[1]; ++y)
      for (std::int32_t x = 0; x < grid.size[0]; ++x)
        if (grid.blocks[block++] >= 0) used.push_back({x, y, z});
  grid.coefficients.resize(used.size() * Grid::kBlockFloats);
  pool.run(used.size(), [&](std::size_t k) {
    float* to = &grid.coefficients[k * Grid::kBlockFloats];
    gather<1, 2, Channels>(layout, coefficients, used[k],
                           [&](std::size_t at, const std::array<float, Channels>* value) {
                             // Never missing about a block.
                             for (std::size_t v = 0; v < Channels; ++v)
                               to[Channels * at + v] = value != nullptr ? (*value)[v] : 0;
                           });
  });
}

template void fitSplines<1>(SplineGrid<1>&, const BlockLayout&, ThreadPool&,
                            const std::function<void(const BlockPlace&, BlockValues<1>&)>&);
template void fitSplines<2>(SplineGrid<2>&, const BlockLayout&, ThreadPool&,
                            const std::function<void(const BlockPlace&, BlockValues<2>&)>&);

}  // namespace migiwa
