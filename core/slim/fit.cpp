#include "core/slim/fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "core/base/math.h"
#include "core/base/progress.h"
#include "core/slim/node.h"
#include "core/slim/points.h"

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
      if (fit.valid) return fit.node;
      return fallback(centre, fixedRadius_, indices);
    }
    const auto holds = [&](const LocalFit& fit) { return fit.valid && fit.node.error <= tolerance_; };
    // The smallest ball with enough points, then doubled while the tolerance holds.
    const float spacing = levels_.spacing();
    float radius = spacing * std::sqrt(static_cast<float>(fewestPoints(degree_)) / 3.14F);
    LocalFit best = fitAt(centre, radius, degree_, indices);
    for (int k = 0; k < 8 && static_cast<int>(indices.size()) < fewestPoints(degree_); ++k) {
      radius *= 1.25F;
      best = fitAt(centre, radius, degree_, indices);
    }
    if (!best.valid) return fallback(centre, radius, indices);
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
      if (fit.valid) return fit.node;
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

namespace {
constexpr std::size_t kMeasuredPoints = 100000;
}

double defaultSlimTolerance(const Bounds& bounds) {
  return 1e-3 * bounds.size().norm();
}

SlimStatistics measureSlim(const SlimModel& model, const std::vector<OrientedPoint>& points,
                           ThreadPool& pool) {
  struct Sums {
    double largest = 0, sum = 0;
  };
  const Sums sums = parallelReduce(
      pool, points.size(), Sums{},
      [&](std::size_t begin, std::size_t end) {
        Sums part;
        for (std::size_t k = begin; k < end; ++k) {
          const double distance = std::abs(static_cast<double>(model.nearest(points[k].position).distance));
          part.largest = std::max(part.largest, distance);
          part.sum += distance;
        }
        return part;
      },
      [](const Sums& a, const Sums& b) {
        return Sums{std::max(a.largest, b.largest), a.sum + b.sum};
      });
  SlimStatistics statistics;
  statistics.largest = sums.largest;
  statistics.mean = points.empty() ? 0 : sums.sum / static_cast<double>(points.size());
  statistics.points = points.size();
  return statistics;
}

SlimStatistics measureSlim(const SlimModel& model, const ImportedShape& shape, ThreadPool& pool) {
  return measureSlim(
      model, shape.isMesh() ? samplePoints(shape.mesh, kMeasuredPoints, 2) : shape.cloud.points, pool);
}

SlimData fitShape(const ImportedShape& shape, SlimFitOptions options, ThreadPool& pool) {
  if (!(options.tolerance > 0) && options.nodes <= 0 && !(options.radius > 0))
    options.tolerance = defaultSlimTolerance(shape.bounds());
  const OrientedPoints points = fitPoints(shape, options.nodes);
  SlimData data;
  {
    Activity activity("fitting a SLIM surface to " + std::to_string(points.points.size()) + " points");
    data.nodes = fitSlim(points, options, pool, [&](double part) { activity.reach(part); });
  }
  const Activity activity("measuring the SLIM surface");
  data.hierarchy = mergeSlim(points, data.nodes, options.degree, pool);
  data.degree = options.degree;
  data.closed = shape.closed;
  const SlimModel model(data.nodes, data.degree, data.closed, pool);
  data.statistics = measureSlim(model, shape, pool);
  return data;
}

std::string cutTo(SlimData& data, double tolerance, int nodes) {
  std::string note;
  const std::size_t held = data.nodes.size(), wanted = static_cast<std::size_t>(std::max(nodes, 0));
  if (tolerance > 0) {
    std::vector<float> errors;
    for (const SlimNode& node : data.nodes) errors.push_back(node.error);
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    if (tolerance < static_cast<double>(*middle)) {
      std::ostringstream text;
      text << "most of its " << held << " nodes err by more than the tolerance of " << tolerance << " m, by "
           << *middle << " m; fit anew with that tolerance";
      note = text.str();
    }
  } else if (wanted > held) {
    note = "it holds " + std::to_string(held) + " nodes, fewer than the " + std::to_string(nodes) +
           " asked for; fit anew with more";
  } else if (wanted > 0) {
    tolerance = toleranceFor(data.nodes, data.hierarchy, wanted);
  }
  if (data.hierarchy.merged.empty()) {
    if (note.empty() && (tolerance > 0 || (wanted > 0 && wanted < held)))
      note = "it holds no coarser levels, all of its " + std::to_string(held) + " nodes are taken; fit anew";
  } else if (tolerance > 0) {
    data.nodes = cutSlim(data.nodes, data.hierarchy, tolerance);
    if (wanted > 0 && data.nodes.size() > wanted)
      note = "its nodes can be merged to no fewer than " + std::to_string(data.nodes.size());
  }
  data.hierarchy = {};
  return note;
}

void transformShape(ImportedShape& shape, const Transform& transform) {
  const Eigen::Matrix3d turn = transform.rotate.matrix();
  for (Vec3d& place : shape.exact) place = turn * (transform.scale * place) + transform.translate;
  const bool exact = !shape.exact.empty();
  for (std::size_t k = 0; k < shape.mesh.vertices.size(); ++k) {
    Vec3f& vertex = shape.mesh.vertices[k];
    vertex = exact ? Vec3f(shape.exact[k].cast<float>()) : transform.point(vertex);
  }
  for (std::size_t k = 0; k < shape.cloud.points.size(); ++k) {
    OrientedPoint& point = shape.cloud.points[k];
    point = {exact ? Vec3f(shape.exact[k].cast<float>()) : transform.point(point.position),
             transform.direction(point.normal)};
  }
}

void transformNodes(std::vector<SlimNode>& nodes, const Transform& transform) {
  const auto scale = static_cast<float>(transform.scale);
  for (SlimNode& node : nodes) {
    node.centre = transform.point(node.centre);
    node.radius *= scale;
    node.error *= scale;
    node.normal = transform.direction(node.normal);
    const Vec3f tangent = transform.direction(node.tangent);
    node.tangent = (tangent - tangent.dot(node.normal) * node.normal).normalized();
    // A term of degree k has the unit m^(1 - k).
    for (std::size_t k = 0; k < node.coefficients.size(); ++k)
      node.coefficients[k] *= k == 0 ? scale : k < 3 ? 1 : k < 6 ? 1 / scale : 1 / (scale * scale);
  }
}

double bowlDistance(const Bowl& bowl, const Vec3d& p, Vec3d& normal) {
  const Vec3d q = p - bowl.center;
  const double length = q.norm(), across = portable::hypot(q.x(), q.z());
  Vec3d foot;  // on the half sphere, or on the cylinder
  if (q.y() <= 0) {
    foot = length > 0 ? Vec3d(bowl.radius / length * q) : Vec3d(0, -bowl.radius, 0);
  } else {
    foot = across > 0 ? Vec3d(bowl.radius / across * Vec3d(q.x(), 0, q.z())) : Vec3d(bowl.radius, 0, 0);
    foot.y() = std::min(q.y(), bowl.height);
  }
  const Vec3d offset = q - foot;
  const double away = offset.norm();
  normal = away > 0 ? Vec3d(offset / away) : Vec3d(foot / bowl.radius);
  return away - 0.5 * bowl.thickness;
}

OrientedPoints bowlPoints(const Bowl& bowl, std::size_t count) {
  constexpr double kPi = std::numbers::pi;
  const double half = 0.5 * bowl.thickness;
  const double inner = bowl.radius - half, outer = bowl.radius + half;
  const double areas[] = {2 * kPi * inner * (inner + bowl.height), 2 * kPi * outer * (outer + bowl.height),
                          // Half a torus, the upper one: Pappus.
                          kPi * half * 2 * kPi * bowl.radius};
  const double total = areas[0] + areas[1] + areas[2];
  OrientedPoints result;
  for (int part = 0; part < 3; ++part) {
    const auto n = static_cast<std::size_t>(std::round(areas[part] / total * static_cast<double>(count)));
    for (std::size_t k = 0; k < n; ++k) {
      // Even in height and by the golden angle around: a Fibonacci set on each part.
      const double along = (static_cast<double>(k) + 0.5) / static_cast<double>(n);
      const double angle = kPi * (3 - std::sqrt(5.0)) * static_cast<double>(k);
      Vec3d around(portable::cos(angle), 0, portable::sin(angle)), normal, foot;
      if (part < 2) {
        // By Archimedes, a sphere has as much area as its cylinder at the same height: the way goes down from
        // the rim to the bottom at one speed.
        const double own = part == 0 ? inner : outer;
        const double down =
            along * (1 + bowl.height / own) - bowl.height / own;  // below the centre, by `own`
        const double sine = -std::max(0.0, down);
        normal = std::sqrt(1 - sine * sine) * around + sine * Vec3d::UnitY();
        foot = bowl.radius * normal + std::max(0.0, -down) * own * Vec3d::UnitY();
        if (part == 0) normal = -normal;
      } else {
        // From the outer side over the top to the inner one; the circumference shrinks on the way, so equal
        // areas are not equal angles: solve angle + (half / radius) sin(angle) = share of the whole by
        // Newton.
        const double ratio = half / bowl.radius;
        double turn = along * kPi;
        for (int step = 0; step < 20; ++step)
          turn -= (turn + ratio * portable::sin(turn) - along * kPi) / (1 + ratio * portable::cos(turn));
        normal = portable::cos(turn) * around + portable::sin(turn) * Vec3d::UnitY();
        foot = bowl.radius * around + bowl.height * Vec3d::UnitY();
      }
      const Vec3d p = bowl.center + foot + half * normal;
      result.points.push_back({p.cast<float>(), normal.cast<float>()});
    }
  }
  return result;
}

}  // namespace migiwa
