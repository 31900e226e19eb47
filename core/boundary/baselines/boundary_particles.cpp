#include "core/boundary/baselines/boundary_particles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/sph/kernels.h"

namespace migiwa {

namespace {

/// Points that are tried, along a spacing, and along a block.
constexpr int kTriedAlong = 3, kBlock = 6;
constexpr double kMostBlocks = 2e7;
constexpr std::size_t kMostParticles = 20'000'000;
/// What a block through which a wall goes takes on the way: some sixty candidates in vectors that grow, and
/// four particles in their cells.
constexpr double kBytesPerBlock = 2000;
/// Nearer to each other than this many spacings no two particles lie.
constexpr float kNearest = 0.99F;

/// Moves p along the normals to the layer at distance `target` (m). False where there is none close by.
bool moveToLayer(const Boundary& boundary, float target, float tolerance, Vec3f& p) {
  constexpr int kMoves = 6;
  for (int move = 0; move < kMoves; ++move) {
    Vec3f normal;
    const float off = boundary.distance(p, normal) - target;
    if (std::abs(off) <= tolerance) return true;
    p -= off * normal;
  }
  return std::abs(boundary.distance(p) - target) <= tolerance;
}

/// The candidates of one block for the layer at `target`, in the order of the lattice.
class Candidates {
 public:
  Candidates(const Boundary& boundary, float spacing, float depth)
      : boundary_(boundary), spacing_(spacing), depth_(depth), pitch_(spacing / kTriedAlong) {}

  /// Whether the block at `corner` may have candidates.
  bool any(const Vec3f& corner) const {
    const float edge = kBlock * pitch_;
    // No wall is nearer to anything in the block than its middle is, less half of its diagonal; a tenth more
    // for distances that are approximate.
    const float middle = boundary_.distance(corner + Vec3f::Constant(0.5F * edge));
    return std::abs(middle + 0.5F * depth_) <= 1.1F * 0.866F * edge + 0.5F * depth_ + pitch_;
  }

  void collect(const Vec3f& corner, std::vector<Vec3f>& layer, std::vector<Vec3f>& thin) const {
    if (!any(corner)) return;
    for (int z = 0; z < kBlock; ++z) {
      for (int y = 0; y < kBlock; ++y) {
        for (int x = 0; x < kBlock; ++x) {
          const Vec3f at =
              corner + pitch_ * Vec3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
          const float distance = boundary_.distance(at);
          if (std::abs(distance + depth_) <= 0.87F * pitch_) {
            if (Vec3f p = at; moveToLayer(boundary_, -depth_, 0.02F * spacing_, p)) layer.push_back(p);
          }
          if (std::abs(distance) <= 0.87F * pitch_) addThin(at, thin);
        }
      }
    }
  }

 private:
  /// Where the solid behind a place of the wall is too thin for the layer: a point midway.
  void addThin(Vec3f p, std::vector<Vec3f>& thin) const {
    if (!moveToLayer(boundary_, 0, 0.02F * spacing_, p)) return;
    Vec3f normal;
    boundary_.distance(p, normal);
    if (boundary_.distance(p - depth_ * normal) <= -0.75F * depth_) return;
    Vec3f deepest = p;
    float least = 0;
    for (int part = 1; part < 8; ++part) {
      const Vec3f inside = p - static_cast<float>(part) / 8 * depth_ * normal;
      const float distance = boundary_.distance(inside);
      if (distance >= least) continue;
      least = distance, deepest = inside;
    }
    thin.push_back(deepest);
  }

  const Boundary& boundary_;
  float spacing_, depth_, pitch_;
};

/// Points of which no two are nearer than a distance, taken in the order in which they come.
class SparsePoints {
 public:
  explicit SparsePoints(float nearest) : nearest_(nearest) {}

  void add(const Vec3f& p) {
    const std::array<std::int64_t, 3> cell = cellOf(p);
    for (std::int64_t z = -1; z <= 1; ++z)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t x = -1; x <= 1; ++x)
          if (const auto known = cells_.find(key(cell[0] + x, cell[1] + y, cell[2] + z));
              known != cells_.end())
            for (const std::uint32_t other : known->second)
              if ((points_[other] - p).squaredNorm() < nearest_ * nearest_) return;
    cells_[key(cell[0], cell[1], cell[2])].push_back(static_cast<std::uint32_t>(points_.size()));
    points_.push_back(p);
  }
  std::size_t size() const { return points_.size(); }
  std::vector<Vec3f> take() { return std::move(points_); }

 private:
  std::array<std::int64_t, 3> cellOf(const Vec3f& p) const {
    const auto along = [&](int axis) { return static_cast<std::int64_t>(std::floor(p[axis] / nearest_)); };
    return {along(0), along(1), along(2)};
  }
  /// 21 bits for each axis: cells that share a key are far apart, and only cost time.
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::uint64_t kMask = (1U << 21) - 1;
    return (static_cast<std::uint64_t>(x) & kMask) | (static_cast<std::uint64_t>(y) & kMask) << 21 |
           (static_cast<std::uint64_t>(z) & kMask) << 42;
  }

  float nearest_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
  std::vector<Vec3f> points_;
};

[[noreturn]] void refuse(const std::string& place) {
  throw InputError(place,
                   "expected walls that 20 million boundary particles at most can cover, found larger "
                   "ones; \"gamma\" needs none, and a larger spacing fewer");
}

}  // namespace

std::vector<Vec3f> sampleWalls(const Boundary& boundary, const Bounds& region, float spacing, float depth,
                               ThreadPool& pool, const std::string& place) {
  if (boundary.empty() || region.empty()) return {};
  const double edge = static_cast<double>(spacing) * kBlock / kTriedAlong;
  const Bounds grown = region.grown(static_cast<double>(depth + spacing));
  const Vec3d blocks = (grown.size() / edge).array().ceil();
  if (blocks.prod() > kMostBlocks) refuse(place);
  const auto across = static_cast<std::size_t>(blocks.x()), up = static_cast<std::size_t>(blocks.y());
  const auto slabs = static_cast<std::size_t>(blocks.z());

  const Candidates candidates(boundary, spacing, depth);
  const auto inSlabs = [&](const auto& ofBlock) {
    pool.run(slabs, [&](std::size_t slab) {
      for (std::size_t k = 0; k < across * up; ++k) {
        const std::size_t x = k % across, y = k / across;
        const Vec3d index(static_cast<double>(x), static_cast<double>(y), static_cast<double>(slab));
        ofBlock(slab, (grown.min + edge * index).cast<float>());
      }
    });
  };
  std::vector<std::size_t> blocksNear(slabs, 0);
  inSlabs(
      [&](std::size_t slab, const Vec3f& corner) { blocksNear[slab] += candidates.any(corner) ? 1U : 0U; });
  requireMemory(kBytesPerBlock * std::accumulate(blocksNear.begin(), blocksNear.end(), 0.0),
                "boundary particles", place);
  std::vector<std::vector<Vec3f>> layers(slabs), thins(slabs);
  inSlabs(
      [&](std::size_t slab, const Vec3f& corner) { candidates.collect(corner, layers[slab], thins[slab]); });

  SparsePoints points(kNearest * spacing);
  for (const std::vector<Vec3f>& slab : layers) {
    for (const Vec3f& p : slab) points.add(p);
    if (points.size() > kMostParticles) refuse(place);
  }
  // Of thin parts the middle first: what lies at their rims is near to that.
  std::vector<std::pair<long, Vec3f>> thin;
  for (const std::vector<Vec3f>& slab : thins)
    for (const Vec3f& p : slab) thin.emplace_back(std::lround(20 * boundary.distance(p) / spacing), p);
  std::stable_sort(thin.begin(), thin.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [depthRank, p] : thin) points.add(p);
  if (points.size() > kMostParticles) refuse(place);
  return points.take();
}

BoundaryParticles::BoundaryParticles(const std::vector<Vec3f>& places, KernelType kernel, float supportRadius,
                                     ThreadPool& pool)
    : inverseSupport_(1 / supportRadius) {
  std::vector<Float4> unsorted;
  unsorted.reserve(places.size());
  for (const Vec3f& p : places) unsorted.emplace_back(p);
  grid_.build(unsorted, supportRadius, pool);
  for (const std::uint32_t k : grid_.order()) particles_.push_back(unsorted[k]);
  std::vector<float> volumes(particles_.size());
  withKernel(kernel, [&](auto type) {
    using Kernel = decltype(type);
    parallelFor(pool, particles_.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t b = begin; b < end; ++b) {
        float sum = 0;
        around(particles_[b].xyz(), [&](const Vec3f&, float q, float) { sum += Kernel::value(q); });
        volumes[b] = 1 / sum;
      }
    });
  });
  for (std::size_t b = 0; b < particles_.size(); ++b) particles_[b].w = volumes[b];
}

}  // namespace migiwa
