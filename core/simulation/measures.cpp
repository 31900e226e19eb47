#include "core/simulation/measures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/sph/neighbours.h"
#include "core/walls/boundary.h"

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
  // Straight from the grid: lists, and even a sorted copy, would take much memory at millions of
  // particles.
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

struct SettledSampler::Walls {
  std::vector<std::shared_ptr<const Surface>> surfaces;
  Boundary boundary;
};

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
  const auto support = static_cast<float>(scene.supportRadius());
  if (walls_ == nullptr || walls_->surfaces != scene.surfaces) {
    walls_ = std::make_shared<Walls>(Walls{scene.surfaces, Boundary(scene.surfaces)});
    walls_->boundary.indexWalls(support);
  }
  walls_->boundary.moveTo(time, time);
  for (const NearestNeighbour& nearest : nearestNeighbours(
           positions, walls_->boundary, static_cast<float>(scene.particleSpacing), support, pool)) {
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

void SpacingHistogram::add(float distance) {
  // A neighbour is within the support radius; beyond it, all are as far.
  constexpr float kFarthest = 1000;
  const auto bin =
      static_cast<std::size_t>(std::lround(std::fmin(distance, kFarthest) * static_cast<float>(kBins)));
  if (bin >= counts_.size()) counts_.resize(bin + 1, 0);
  ++counts_[bin];
}

double SpacingHistogram::atRank(std::uint64_t rank) const {
  std::uint64_t seen = 0;
  std::size_t bin = 0;
  while (seen + counts_[bin] <= rank) seen += counts_[bin++];
  return static_cast<double>(bin) / kBins;
}

std::optional<double> SpacingHistogram::firstPercentile() const {
  const std::uint64_t total = std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
  if (total == 0) return std::nullopt;
  const double place = 0.01 * static_cast<double>(total - 1);
  const auto low = static_cast<std::uint64_t>(place);
  const double a = atRank(low);
  if (low + 1 == total) return a;
  return a + (place - static_cast<double>(low)) * (atRank(low + 1) - a);
}

void SpacingHistogram::visit(StateVisitor& visitor, const std::string& name) {
  std::vector<std::uint32_t> bins;
  std::vector<std::uint64_t> counts;
  for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
    if (counts_[bin] == 0) continue;
    bins.push_back(static_cast<std::uint32_t>(bin));
    counts.push_back(counts_[bin]);
  }
  visitor.array(name + "/bins", bins);
  visitor.array(name + "/counts", counts);
  if (!visitor.reading()) return;
  constexpr std::uint32_t kMost = 1000 * kBins;
  if (bins.size() != counts.size() || (!bins.empty() && bins.back() > kMost))
    throw StateError("a count for every bin of " + name + ", found something else");
  counts_.assign(bins.empty() ? 0 : std::size_t{bins.back()} + 1, 0);
  for (std::size_t k = 0; k < bins.size(); ++k) counts_.at(bins[k]) = counts[k];
}

std::optional<UprightTank> uprightTank(const Scene& scene) {
  if (scene.gravity.norm() <= 0 || scene.surfaces.size() != 1 || scene.surfaces.front()->motion)
    return std::nullopt;
  const BoxGeometry* box = scene.surfaces.front()->tank();
  if (box == nullptr) return std::nullopt;
  int axis = 0;
  const Vec3d along = box->axes.transpose() * -scene.gravity.normalized();
  if (along.cwiseAbs().maxCoeff(&axis) < 0.9999) return std::nullopt;
  const int first = (axis + 2) % 3, second = (axis + 1) % 3;
  UprightTank tank;
  tank.center = box->center;
  tank.axes << box->axes.col(first), std::copysign(1.0, along[axis]) * box->axes.col(axis),
      box->axes.col(second);
  tank.half = {box->halfExtents[first], box->halfExtents[axis], box->halfExtents[second]};
  return tank;
}

SettledMeasures runUntil(Simulation& simulation, double until, const std::function<bool()>& eachFrame) {
  SettledSampler sampler;
  return runUntil(simulation, until, sampler, eachFrame);
}

SettledMeasures runUntil(Simulation& simulation, double until, SettledSampler& sampler,
                         const std::function<bool()>& eachFrame) {
  const long last = simulation.frameAt(until);
  const long firstSampled = static_cast<long>(std::floor(0.9 * static_cast<double>(last)));
  // Samples of neighbouring frames hardly differ: some fifty of them say what all would.
  const long stride = std::max(1L, (last - firstSampled) / 50);
  sampler.beginRun(last);
  while (simulation.frame() < last && !simulation.stopped()) {
    simulation.advanceFrame();
    const long frame = simulation.frame();
    if (frame > firstSampled && (last - frame) % stride == 0) sampler.sample(simulation);
    if (eachFrame && !eachFrame()) break;
  }
  return sampler.result();
}

}  // namespace migiwa
