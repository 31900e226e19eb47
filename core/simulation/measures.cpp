#include "core/simulation/measures.h"

#include <algorithm>
#include <cmath>

#include "core/boundary/boundary.h"
#include "core/sph/neighbour_lists.h"

namespace migiwa {

namespace {

struct Tank {
  Vec3d center;
  Eigen::Matrix3d axes;  ///< columns; the second points up
  Vec3d half;            ///< along those axes
};

/// The first box that holds the fluid, if gravity runs along one of its axes.
std::optional<Tank> uprightTank(const Scene& scene) {
  if (scene.gravity.norm() <= 0) return std::nullopt;
  const Vec3d up = -scene.gravity.normalized();
  for (const auto& surface : scene.surfaces) {
    const BoxGeometry* box = surface->tank();
    if (box == nullptr) continue;
    int axis = 0;
    const Vec3d along = box->axes.transpose() * up;
    if (along.cwiseAbs().maxCoeff(&axis) < 0.9999) return std::nullopt;
    const int first = (axis + 2) % 3, second = (axis + 1) % 3;
    Tank tank;
    tank.center = box->center;
    tank.axes << box->axes.col(first), std::copysign(1.0, along[axis]) * box->axes.col(axis),
        box->axes.col(second);
    tank.half = {box->halfExtents[first], box->halfExtents[axis], box->halfExtents[second]};
    return tank;
  }
  return std::nullopt;
}

/// Volume of the strips of cross-section a x a along the four vertical edges and the four floor edges, up to
/// `level`.
double stripVolume(const Tank& tank, double a, double level) {
  const double width = 2 * tank.half.x() - 2 * a, depth = 2 * tank.half.z() - 2 * a;
  return 4 * a * a * level + 2 * a * std::min(a, level) * (width + depth);
}

bool inStrip(const Vec3d& local, const Tank& tank, double a) {
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
  std::vector<Float4> sorted(positions.size());
  for (std::size_t k = 0; k < sorted.size(); ++k) sorted[k] = positions[grid.order()[k]];
  NeighbourLists lists;
  lists.build(grid, sorted, support, pool);
  std::vector<NearestNeighbour> result(sorted.size());
  parallelFor(pool, sorted.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f at = sorted[i].xyz();
      float nearest = std::numeric_limits<float>::infinity();
      for (const std::uint32_t j : lists.of(i))
        nearest = std::min(nearest, (at - sorted[j].xyz()).squaredNorm());
      result[i] = {std::sqrt(nearest) / spacing, boundary.distance(at) < support};
    }
  });
  return result;
}

/// 1st percentile, by linear interpolation between order statistics.
std::optional<double> firstPercentile(std::vector<float> values) {
  if (values.empty()) return std::nullopt;
  const double place = 0.01 * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), values.begin() + low, values.end());
  const auto a = static_cast<double>(values[static_cast<std::size_t>(low)]);
  if (static_cast<std::size_t>(low) + 1 == values.size()) return a;
  const auto b = static_cast<double>(*std::min_element(values.begin() + low + 1, values.end()));
  return a + (place - static_cast<double>(low)) * (b - a);
}

}  // namespace

void SettledSampler::sample(const Simulation& simulation) {
  const FrameView view = simulation.view();
  sample(simulation.scene(), view.positions, view.velocities);
}

void SettledSampler::sample(const Scene& scene, std::span<const Float4> positions,
                            std::span<const Float4> velocities) {
  const std::size_t n = positions.size();
  if (n == 0) return;
  ++sums_.frames;
  double squaredSpeed = 0;
  for (const Float4& v : velocities) squaredSpeed += v.xyz().cast<double>().squaredNorm();
  sums_.squaredSpeed += squaredSpeed / static_cast<double>(n);

  ThreadPool pool(1);
  const Boundary boundary(scene.surfaces);
  for (const NearestNeighbour& nearest :
       nearestNeighbours(positions, boundary, static_cast<float>(scene.particleSpacing),
                         static_cast<float>(scene.supportRadius()), pool)) {
    if (std::isfinite(nearest.distance)) (nearest.nearWall ? nearWall_ : bulk_).push_back(nearest.distance);
  }

  const std::optional<Tank> tank = uprightTank(scene);
  if (!tank) return;
  const double a = scene.particleSpacing;
  const double floorArea = 4 * tank->half.x() * tank->half.z();
  const double level = static_cast<double>(n) * a * a * a / floorArea;
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
  measures.nearWallSpacingP1 = firstPercentile(nearWall_);
  measures.bulkSpacingP1 = firstPercentile(bulk_);
  if (sums_.frames > 0) measures.rmsSpeed = std::sqrt(sums_.squaredSpeed / sums_.frames);
  if (sums_.boxFrames > 0) {
    measures.height = sums_.height / sums_.boxFrames;
    measures.expectedHeight = sums_.expectedHeight / sums_.boxFrames;
    measures.edgeCrowding = sums_.edgeCrowding / sums_.boxFrames;
  }
  return measures;
}

}  // namespace migiwa
