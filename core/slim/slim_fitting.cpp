#include "core/slim/slim_fitting.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/slim/mesh_sampling.h"

namespace migiwa {

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

SlimData fitShape(const ImportedShape& shape, SlimFitOptions options, ThreadPool& pool,
                  const std::function<void(double)>& progress) {
  if (!(options.tolerance > 0) && options.nodes <= 0 && !(options.radius > 0))
    options.tolerance = defaultSlimTolerance(shape.bounds());
  const OrientedPoints points = fitPoints(shape, options.nodes);
  SlimData data;
  data.nodes = fitSlim(points, options, pool, progress);
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
  for (Vec3f& vertex : shape.mesh.vertices) vertex = transform.point(vertex);
  for (OrientedPoint& point : shape.cloud.points)
    point = {transform.point(point.position), transform.direction(point.normal)};
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

}  // namespace migiwa
