#include "core/surface/grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/sph/kernels.h"

namespace migiwa::surface {

namespace {

/// Half of what the kernel sums to within the liquid: on a flat surface it reaches as far into the liquid as
/// out of it.
constexpr float kLevel = 0.5F;
/// Less than this is air, whatever gamma: no corner of two right angles covers more of the kernel.
constexpr float kSurelyAir = 0.02F;
/// Memory of a block with all that the mesh takes in it, at most (bytes).
constexpr double kBytesPerBlock = 12000;

bool before(const Index3& a, const Index3& b) {
  return std::array{a[2], a[1], a[0]} < std::array{b[2], b[1], b[0]};
}

int blockOf(double place, double cell) {
  const double node = std::floor(place / cell - 0.5);
  return static_cast<int>(std::floor(node / Block::kSide));
}

/// Calls body(row) for the rows of cells that reach a box.
template <class Body>
void rowsAbout(const CellGrid& cells, const Vec3f& low, const Vec3f& high, const Body& body) {
  const CellGrid::Cell from = cells.cellOf(Float4(low)), to = cells.cellOf(Float4(high));
  for (int z = from.z; z <= to.z; ++z)
    for (int y = from.y; y <= to.y; ++y)
      if (const auto row = cells.row(from.x, to.x, y, z); row.from < row.to) body(row);
}

}  // namespace

float kernelSum(const SortedParticles& particles, const Vec3f& p) {
  const float inverse = 1 / particles.supportRadius;
  const Vec3f reach = Vec3f::Constant(particles.supportRadius);
  return withKernel(particles.kernel, [&](auto kernel) {
    float sum = 0;
    rowsAbout(particles.cells, p - reach, p + reach, [&](const CellGrid::Places& row) {
      for (std::uint32_t k = row.from; k < row.to; ++k) {
        const float squared = ((particles.positions[k].xyz() - p) * inverse).squaredNorm();
        if (squared < 1) sum += particles.positions[k].w * decltype(kernel)::value(std::sqrt(squared));
      }
    });
    return sum;
  });
}

Grid::Grid(const SortedParticles& particles, const LiquidWalls& walls, double spacing, double cell,
           const std::string& place, ThreadPool& pool)
    : particles_(particles), walls_(walls), spacing_(spacing), cell_(cell) {
  findBlocks(place, pool);
  if (walls_.boundary != nullptr && walls_.boundary->empty()) walls_.boundary = nullptr;
  pool.run(blocks_.size(), [&](std::size_t k) {
    Block& block = blocks_[k];
    for (int z = -1, n = 0; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          block.around[static_cast<std::size_t>(n++)] =
              find({block.at[0] + x, block.at[1] + y, block.at[2] + z});
    sum(block);
    measure(block);
    correct(block);
  });
}

void Grid::findBlocks(const std::string& place, ThreadPool& pool) {
  const std::span<const Float4> positions = particles_.positions;
  const double reach = static_cast<double>(particles_.supportRadius) + cell_;
  // Particles follow one another along cells: a few neighbours together ask for the same blocks.
  struct Found {
    std::vector<Index3> blocks;
  };
  std::vector<Found> found(chunkCount(positions.size()));
  parallelFor(pool, positions.size(), [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    std::vector<Index3>& blocks = found[chunk].blocks;
    for (std::size_t i = begin; i < end;) {
      const CellGrid::Cell cell = particles_.cells.cellOf(positions[i]);
      Bounds bounds;
      for (; i < end; ++i) {
        const CellGrid::Cell next = particles_.cells.cellOf(positions[i]);
        if (next.x != cell.x || next.y != cell.y || next.z != cell.z) break;
        bounds.include(positions[i].xyz().cast<double>());
      }
      Index3 low, high;
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        low[a] = blockOf(bounds.min[axis] - reach, cell_), high[a] = blockOf(bounds.max[axis] + reach, cell_);
      }
      for (int z = low[2]; z <= high[2]; ++z)
        for (int y = low[1]; y <= high[1]; ++y)
          for (int x = low[0]; x <= high[0]; ++x) blocks.push_back({x, y, z});
    }
    std::sort(blocks.begin(), blocks.end(), before);
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  });
  std::vector<Index3> all;
  for (const Found& part : found) all.insert(all.end(), part.blocks.begin(), part.blocks.end());
  std::sort(all.begin(), all.end(), before);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  requireMemory(static_cast<double>(all.size()) * kBytesPerBlock, "the grid of the surface", place);
  blocks_.resize(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) blocks_[k].at = all[k];
}

std::int32_t Grid::find(const Index3& at) const {
  const auto place =
      std::lower_bound(blocks_.begin(), blocks_.end(), at,
                       [](const Block& block, const Index3& wanted) { return before(block.at, wanted); });
  return place != blocks_.end() && place->at == at ? static_cast<std::int32_t>(place - blocks_.begin()) : -1;
}

Vec3d Grid::place(const Block& block, int x, int y, int z) const {
  return cell_ * Vec3d(block.at[0] * Block::kSide + x + 0.5, block.at[1] * Block::kSide + y + 0.5,
                       block.at[2] * Block::kSide + z + 0.5);
}

void Grid::sum(Block& block) const {
  block.value.fill(0);
  const Vec3f reach = Vec3f::Constant(particles_.supportRadius);
  const Vec3d first = place(block, 0, 0, 0),
              last = place(block, Block::kSide - 1, Block::kSide - 1, Block::kSide - 1);
  std::vector<CellGrid::Places> rows;
  rowsAbout(particles_.cells, first.cast<float>() - reach, last.cast<float>() + reach,
            [&](const CellGrid::Places& row) { rows.push_back(row); });
  addKernelSums(particles_, rows, {first, cell_}, block.value);
}

void Grid::measure(Block& block) const {
  block.distance.fill(std::numeric_limits<float>::infinity());
  if (walls_.boundary == nullptr) return;
  const double half = 0.5 * (Block::kSide - 1);
  if (walls_.boundary->steady()) {
    const Vec3f middle = (place(block, 0, 0, 0) + Vec3d::Constant(half * cell_)).cast<float>();
    const auto radius = static_cast<float>(std::sqrt(3.0) * half * cell_);
    if (walls_.boundary->distance(middle) > 1.01F * radius + particles_.supportRadius) return;
  }
  block.walls = true;
  for (int z = 0; z < Block::kSide; ++z)
    for (int y = 0; y < Block::kSide; ++y)
      for (int x = 0; x < Block::kSide; ++x)
        block.distance[static_cast<std::size_t>(Block::index(x, y, z))] =
            walls_.boundary->distance(place(block, x, y, z).cast<float>());
}

void Grid::correct(Block& block) const {
  std::vector<std::size_t> nodes;
  std::vector<Float4> points;
  const float support = particles_.supportRadius;
  for (std::size_t n = 0; n < Block::kNodes; ++n) {
    if (!block.walls || block.distance[n] <= 0 || block.distance[n] >= support || block.value[n] < kSurelyAir)
      continue;
    const int at = static_cast<int>(n);
    nodes.push_back(n);
    points.emplace_back(
        place(block, at % Block::kSide, at / Block::kSide % Block::kSide, at / (Block::kSide * Block::kSide))
            .cast<float>());
  }
  std::vector<GammaSample> samples(points.size());
  if (!points.empty()) walls_.gamma->evaluate(points, samples);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    block.value[nodes[k]] /= std::max(samples[k].gamma, kSurelyAir);
  for (std::size_t n = 0; n < Block::kNodes; ++n) {
    block.value[n] -= kLevel;
    block.label[n] = block.distance[n] <= 0 ? Label::solid : block.value[n] >= 0 ? Label::water : Label::air;
  }
}

float Grid::valueAt(const Vec3f& p) const {
  float sum = kernelSum(particles_, p);
  if (walls_.boundary != nullptr && sum >= kSurelyAir) {
    const std::array<Float4, 1> point{Float4(p)};
    std::array<GammaSample, 1> sample;
    walls_.gamma->evaluate(point, sample);
    sum /= std::max(sample[0].gamma, kSurelyAir);
  }
  return sum - kLevel;
}

Vec3f Grid::onLevel(Vec3f p) const {
  constexpr int kRounds = 3;
  const float aside = 0.05F * cell();
  for (int round = 0; round < kRounds; ++round) {
    const float value = valueAt(p);
    Vec3f gradient;
    for (int axis = 0; axis < 3; ++axis)
      gradient[axis] = (valueAt(p + aside * Vec3f::Unit(axis)) - value) / aside;
    const float squared = gradient.squaredNorm();
    if (squared * cell() * cell() < 1e-4F) break;
    Vec3f move = -value / squared * gradient;
    if (const float length = move.norm(); length > 0.5F * cell()) move *= 0.5F * cell() / length;
    p += move;
  }
  return p;
}

Vec3f Grid::ontoWall(Vec3f& p) const {
  constexpr int kRounds = 4, kHalvings = 20;
  const float close = 1e-5F * cell();
  Vec3f normal;
  float distance = walls_.boundary->distance(p, normal);
  for (int round = 0; round < kRounds && std::abs(distance) > close; ++round) {
    p -= distance * normal;
    distance = walls_.boundary->distance(p, normal);
  }
  if (std::abs(distance) <= close) return normal;
  // Near rims a distance from a grid leads past the wall to and fro: then between two points on either side.
  Vec3f one = p, other = p - 2 * distance * normal;
  if ((walls_.boundary->distance(other) > 0) == (distance > 0)) return normal;
  for (int halving = 0; halving < kHalvings && std::abs(distance) > close; ++halving) {
    p = 0.5F * (one + other);
    const float middle = walls_.boundary->distance(p, normal);
    ((middle > 0) == (distance > 0) ? one : other) = p;
    if (std::abs(middle) <= close) break;
  }
  return normal;
}

}  // namespace migiwa::surface
