#include "core/slim/slim_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/bounds.h"
#include "core/base/portable_math.h"
#include "core/slim/local_fit.h"
#include "core/slim/point_levels.h"

namespace migiwa {

namespace {

/// Balls fitted at a time, before any of them is accepted.
constexpr std::size_t kBatch = 128;
/// Halvings of the interval, in the logarithm, between a radius that holds the tolerance and twice of it.
constexpr int kRefinements = 4;

class Covering {
 public:
  Covering(const PointLevels& levels, int degree, float largest, ThreadPool& pool)
      : levels_(levels), degree_(degree), largest_(largest), pool_(pool) {}

  std::vector<SlimNode> cover(float tolerance, float fixedRadius,
                              const std::function<void(double)>& progress) {
    tolerance_ = tolerance;
    fixedRadius_ = fixedRadius;
    const auto points = levels_.points();
    std::vector<std::uint8_t> covered(points.size(), 0);
    std::vector<SlimNode> nodes;
    std::vector<std::uint32_t> batch, reached;
    std::vector<SlimNode> fitted(kBatch);
    std::size_t next = 0;
    while (next < points.size()) {
      batch.clear();
      for (; next < points.size() && batch.size() < kBatch; ++next)
        if (covered[next] == 0) batch.push_back(static_cast<std::uint32_t>(next));
      constexpr std::size_t kAtATime = 8;
      pool_.run((batch.size() + kAtATime - 1) / kAtATime, [&](std::size_t chunk) {
        const std::size_t end = std::min(batch.size(), (chunk + 1) * kAtATime);
        for (std::size_t k = chunk * kAtATime; k < end; ++k) fitted[k] = largestBall(points[batch[k]]);
      });
      // In the order of the points, so that threads make no difference.
      for (std::size_t k = 0; k < batch.size(); ++k) {
        if (covered[batch[k]] != 0) continue;
        const SlimNode& node = fitted[k];
        nodes.push_back(node);
        levels_.withinAll(node.centre, kSlimCore * node.radius, reached);
        for (const std::uint32_t index : reached) covered[index] = 1;
        covered[batch[k]] = 1;
      }
      if (progress) progress(static_cast<double>(next) / static_cast<double>(points.size()));
    }
    return nodes;
  }

  /// About how many balls cover() takes: each covers its core, of which that much is not covered by others.
  double estimate(float tolerance) {
    constexpr std::size_t kSamples = 1000, kAtATime = 8;
    constexpr double kOwnShare = 0.46;
    tolerance_ = tolerance;
    fixedRadius_ = 0;
    const auto points = levels_.points();  // in random order
    const std::size_t samples = std::min(kSamples, points.size());
    std::vector<double> radii(samples);
    pool_.run((samples + kAtATime - 1) / kAtATime, [&](std::size_t chunk) {
      for (std::size_t k = chunk * kAtATime; k < std::min(samples, (chunk + 1) * kAtATime); ++k)
        radii[k] = static_cast<double>(largestBall(points[k]).radius);
    });
    const double core = static_cast<double>(kSlimCore), spacing = static_cast<double>(levels_.spacing());
    const double area = spacing * spacing * static_cast<double>(points.size());
    double balls = 0;
    for (const double radius : radii)
      balls += area / (kOwnShare * std::numbers::pi * core * core * radius * radius);
    return balls / static_cast<double>(samples);
  }

 private:
  LocalFit fitAt(const OrientedPoint& centre, float radius, int degree,
                 std::vector<std::uint32_t>& indices) const {
    levels_.within(centre.position, radius, wantedPoints(degree), indices);
    return fitLocally(levels_.points(), indices, centre.position, radius, degree);
  }

  SlimNode largestBall(const OrientedPoint& centre) const {
    std::vector<std::uint32_t> indices;
    if (fixedRadius_ > 0) {
      const LocalFit fit = fitAt(centre, fixedRadius_, degree_, indices);
      if (fit.sound) return fit.node;
      return fallback(centre, fixedRadius_, indices);
    }
    const auto holds = [&](const LocalFit& fit) { return fit.sound && fit.node.error <= tolerance_; };
    // The smallest ball with enough points, then doubled while the tolerance holds.
    const float spacing = levels_.spacing();
    float radius = spacing * std::sqrt(static_cast<float>(fewestPoints(degree_)) / 3.14F);
    LocalFit best = fitAt(centre, radius, degree_, indices);
    for (int k = 0; k < 8 && static_cast<int>(indices.size()) < fewestPoints(degree_); ++k) {
      radius *= 1.25F;
      best = fitAt(centre, radius, degree_, indices);
    }
    if (!best.sound) return fallback(centre, radius, indices);
    if (!holds(best)) return best.node;
    float ceiling = 0;
    while (2 * best.node.radius <= largest_) {
      const LocalFit wider = fitAt(centre, 2 * best.node.radius, degree_, indices);
      if (!holds(wider)) {
        ceiling = 2 * best.node.radius;
        break;
      }
      best = wider;
    }
    if (ceiling == 0) return best.node;
    for (int k = 0; k < kRefinements; ++k) {
      const float middle = std::sqrt(best.node.radius * ceiling);
      const LocalFit between = fitAt(centre, middle, degree_, indices);
      if (holds(between)) {
        best = between;
      } else {
        ceiling = middle;
      }
    }
    return best.node;
  }

  /// Where the points are too few, or their normals too wide apart, for the degree: a lower one, and in the
  /// end the plane of the centre's own normal. On creases and thin sheets only points that face the same way
  /// count.
  SlimNode fallback(const OrientedPoint& centre, float radius, std::vector<std::uint32_t>& indices) const {
    levels_.within(centre.position, radius, wantedPoints(degree_), indices);
    const auto points = levels_.points();
    std::erase_if(indices,
                  [&](std::uint32_t index) { return points[index].normal.dot(centre.normal) < 0.5F; });
    for (int degree = degree_; degree >= 1; --degree) {
      const LocalFit fit = fitLocally(points, indices, centre.position, radius, degree);
      if (fit.sound) return fit.node;
    }
    SlimNode plane;
    plane.centre = centre.position;
    plane.radius = radius;
    plane.normal = centre.normal;
    plane.tangent = tangentOf(plane.normal);
    return plane;
  }

  const PointLevels& levels_;
  int degree_;
  float largest_;
  ThreadPool& pool_;
  float tolerance_ = 0, fixedRadius_ = 0;
};

}  // namespace

std::vector<SlimNode> fitSlim(const OrientedPoints& points, const SlimFitOptions& options, ThreadPool& pool,
                              const std::function<void(double)>& progress) {
  if (points.points.empty()) return {};
  const PointLevels levels(points.points);
  Bounds bounds;
  for (const OrientedPoint& point : points.points) bounds.include(point.position.cast<double>());
  const double extent = bounds.size().norm();
  Covering covering(levels, options.degree, static_cast<float>(kLargestSlimRadius * extent), pool);
  if (options.nodes <= 0 || options.radius > 0)
    return covering.cover(static_cast<float>(options.tolerance), static_cast<float>(options.radius),
                          progress);

  // From an estimate of the number of balls at any tolerance, corrected by what a covering really takes.
  const double wanted = options.nodes;
  double low = 1e-8 * extent, high = extent, missing = 1;
  std::vector<SlimNode> best;
  constexpr int kMostCoverings = 4;
  for (int round = 0; round < kMostCoverings; ++round) {
    while (high > 1.01 * low) {
      const double middle = std::sqrt(low * high);
      (covering.estimate(static_cast<float>(middle)) * missing > wanted ? low : high) = middle;
    }
    std::vector<SlimNode> nodes = covering.cover(static_cast<float>(high), 0, {});
    if (progress) progress((round + 1.0) / kMostCoverings);
    const auto missed = [&](const std::vector<SlimNode>& found) {
      return std::abs(portable::log(static_cast<double>(found.size()) / wanted));
    };
    missing *= static_cast<double>(nodes.size()) /
               std::max(1.0, covering.estimate(static_cast<float>(high)) * missing);
    low = high / 8, high *= 8;
    if (best.empty() || missed(nodes) < missed(best)) best = std::move(nodes);
    if (missed(best) < 0.05) break;
  }
  return best;
}

}  // namespace migiwa
