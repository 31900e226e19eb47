#include "core/simulation/measures.h"

#include <algorithm>
#include <cmath>

#include "core/boundary/boundary.h"
#include "core/simulation/upright_tank.h"
#include "core/sph/cell_grid.h"

namespace migiwa {

namespace {

/// Volume of the strips of cross-section a x a along the four vertical edges and the four floor edges, up to
/// `level`.
double stripVolume(const UprightTank& tank, double a, double level) {
  const double width = 2 * tank.half.x() - 2 * a, depth = 2 * tank.half.z() - 2 * a;
  return 4 * a * a * level + 2 * a * std::min(a, level) * (width + depth);
}

bool inStrip(const Vec3d& local, const UprightTank& tank, double a) {
  const bool nearX = tank.half.x() - std::abs(local.x()) < a;
  const bool nearZ = tank.half.z() - std::abs(local.z()) < a;
  const bool nearFloor = local.y() + tank.half.y() < a;
  return (nearX && nearZ) || (nearFloor && (nearX || nearZ));
}

struct NearestNeighbour {
  float distance;  ///< over the spacing; infinite if none is within reach
  bool nearWall;
};

std::vector<NearestNeighbour> nearestNeighbours(std::span<const Float4> positions, const Boundary& boundary,
                                                float spacing, float support, ThreadPool& pool) {
  CellGrid grid;
  grid.build(positions, support, pool);
  // Straight from the grid: lists, and even a sorted copy, would be felt at millions of particles.
  const std::vector<std::uint32_t>& order = grid.order();
  std::vector<NearestNeighbour> result(order.size());
  parallelFor(pool, order.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Float4& own = positions[order[i]];
      const Vec3f at = own.xyz();
      const CellGrid::Cell cell = grid.cellOf(own);
      float nearest = support * support;
      bool found = false;
      for (int row = 0; row < 9; ++row) {
        const auto [from, to] = grid.row(cell.x - 1, cell.x + 1, cell.y + row % 3 - 1, cell.z + row / 3 - 1);
        for (std::uint32_t j = from; j < to; ++j) {
          const float squared = (at - positions[order[j]].xyz()).squaredNorm();
          if (j == i || squared >= nearest) continue;
          nearest = squared;
          found = true;
        }
      }
      const float distance = found ? std::sqrt(nearest) / spacing : std::numeric_limits<float>::infinity();
      result[i] = {distance, boundary.distance(at) < support};
    }
  });
  return result;
}

}  // namespace

void SettledSampler::sample(const Simulation& simulation) {
  const FrameView view = simulation.view();
  sample(simulation.scene(), view.positions, view.velocities, simulation.time());
}

void SettledSampler::sample(const Scene& scene, std::span<const Float4> positions,
                            std::span<const Float4> velocities, double time) {
  const std::size_t n = positions.size();
  if (n == 0) return;
  ++sums_.frames;
  double squaredSpeed = 0;
  for (const Float4& v : velocities) squaredSpeed += v.xyz().cast<double>().squaredNorm();
  sums_.squaredSpeed += squaredSpeed / static_cast<double>(n);

  ThreadPool pool(1);
  Boundary boundary(scene.surfaces);
  boundary.moveTo(time, time);
  for (const NearestNeighbour& nearest :
       nearestNeighbours(positions, boundary, static_cast<float>(scene.particleSpacing),
                         static_cast<float>(scene.supportRadius()), pool)) {
    if (std::isfinite(nearest.distance)) (nearest.nearWall ? nearWall_ : bulk_).add(nearest.distance);
  }

  const std::optional<UprightTank> tank = uprightTank(scene);
  if (!tank) return;
  const double a = scene.particleSpacing;
  const double level = tank->levelOf(static_cast<double>(n) * a * a * a);
  double heights = 0;
  long crowded = 0;
  for (const Float4& p : positions) {
    const Vec3d local = tank->axes.transpose() * (p.xyz().cast<double>() - tank->center);
    const double height = local.y() + tank->half.y();
    heights += height;
    if (height < level && inStrip(local, *tank, a)) ++crowded;
  }
  ++sums_.boxFrames;
  sums_.height += 2 * heights / static_cast<double>(n);
  sums_.expectedHeight += level;
  sums_.edgeCrowding += static_cast<double>(crowded) * a * a * a / stripVolume(*tank, a, level);
}

SettledMeasures SettledSampler::result() const {
  SettledMeasures measures;
  measures.nearWallSpacingP1 = nearWall_.firstPercentile();
  measures.bulkSpacingP1 = bulk_.firstPercentile();
  if (sums_.frames > 0) measures.rmsSpeed = std::sqrt(sums_.squaredSpeed / sums_.frames);
  if (sums_.boxFrames > 0) {
    measures.height = sums_.height / sums_.boxFrames;
    measures.expectedHeight = sums_.expectedHeight / sums_.boxFrames;
    measures.edgeCrowding = sums_.edgeCrowding / sums_.boxFrames;
  }
  return measures;
}

void SettledSampler::beginRun(long last) {
  if (last_ != last) *this = SettledSampler();
  last_ = last;
}

void SettledSampler::visit(StateVisitor& visitor) {
  visitor.integer("/settled/last_frame", last_);
  visitor.integer("/settled/frames", sums_.frames);
  visitor.integer("/settled/box_frames", sums_.boxFrames);
  visitor.number("/settled/height", sums_.height);
  visitor.number("/settled/expected_height", sums_.expectedHeight);
  visitor.number("/settled/edge_crowding", sums_.edgeCrowding);
  visitor.number("/settled/squared_speed", sums_.squaredSpeed);
  nearWall_.visit(visitor, "settled/near_wall");
  bulk_.visit(visitor, "settled/bulk");
}

}  // namespace migiwa
