#include "core/slim/cloud_repair.h"

#include <algorithm>
#include <tuple>

#include "core/base/bounds.h"
#include "core/base/error.h"
#include "core/slim/normal_estimation.h"
#include "core/slim/point_levels.h"

namespace migiwa {

namespace {

constexpr std::size_t kFewestPoints = 50;
/// Mean normal of a surface, up to which it counts as closed.
constexpr double kMostOpen = 0.1;

std::tuple<float, float, float> inOrder(const OrientedPoint& point) {
  return {point.position.x(), point.position.y(), point.position.z()};
}

std::size_t turnAgainstNeighbours(std::vector<OrientedPoint>& points) {
  std::size_t turned = 0;
  std::vector<std::uint32_t> around;
  for (int round = 0; round < 3; ++round) {
    PointLevels levels(points);
    const float reach = 3 * levels.spacing();
    std::vector<OrientedPoint> next(levels.points().begin(), levels.points().end());
    std::size_t before = turned;
    for (OrientedPoint& point : next) {
      levels.withinAll(point.position, reach, around);
      Vec3f mean = Vec3f::Zero();
      for (const std::uint32_t index : around) mean += levels.points()[index].normal;
      if (around.size() < 4 || mean.dot(point.normal) > -0.3F * static_cast<float>(around.size())) continue;
      point.normal = -point.normal;
      ++turned;
    }
    points = std::move(next);
    if (turned == before) break;
  }
  return turned;
}

/// Negative where most normals face the middle of the points.
double outwardFlux(const std::vector<OrientedPoint>& points) {
  Bounds bounds;
  for (const OrientedPoint& point : points) bounds.include(point.position.cast<double>());
  double flux = 0;
  for (const OrientedPoint& point : points)
    flux += point.normal.cast<double>().dot(point.position.cast<double>() - bounds.center());
  return flux;
}

void turnAll(std::vector<OrientedPoint>& points) {
  for (OrientedPoint& point : points) point.normal = -point.normal;
}

}  // namespace

bool repairCloud(std::vector<OrientedPoint>& points, const std::string& place,
                 std::vector<std::string>& notes) {
  std::stable_sort(points.begin(), points.end(),
                   [](const OrientedPoint& a, const OrientedPoint& b) { return inOrder(a) < inOrder(b); });
  const std::size_t all = points.size();
  points.erase(
      std::unique(points.begin(), points.end(),
                  [](const OrientedPoint& a, const OrientedPoint& b) { return inOrder(a) == inOrder(b); }),
      points.end());
  if (points.size() < all)
    notes.push_back(std::to_string(all - points.size()) +
                    " points at the same place as another one were left out");
  if (points.size() < kFewestPoints)
    throw InputError(place, "expected a mesh, or at least " + std::to_string(kFewestPoints) +
                                " points, found " + std::to_string(points.size()) + " points");
  if (points[0].normal.isZero()) {
    estimateNormals(points, place);
    notes.emplace_back("normals were estimated from neighbouring points, and made to face outwards");
    return true;
  }
  if (const std::size_t turned = turnAgainstNeighbours(points); turned > 0)
    notes.push_back(std::to_string(turned) + " normals were turned to agree with their neighbours");
  const bool inwards = outwardFlux(points) < 0;
  // Whole parts that face the other way than the rest.
  std::vector<OrientedPoint> agreed = points;
  if (inwards) turnAll(agreed);
  if (const std::size_t turned = orientNormals(agreed); turned > 0) {
    points = std::move(agreed);
    notes.push_back(std::to_string(turned) + " normals were turned so that all of them face outwards");
    return true;
  }

  Vec3d mean = Vec3d::Zero();
  for (const OrientedPoint& point : points)
    mean += point.normal.cast<double>() / static_cast<double>(points.size());
  const bool closed = mean.norm() < kMostOpen;
  if (!closed) {
    notes.emplace_back(
        "the points do not seem to cover a closed surface: inside and outside are known near it only");
    return false;
  }
  if (inwards) {
    turnAll(points);
    notes.emplace_back("all normals were turned: they pointed inwards");
  }
  return true;
}

}  // namespace migiwa
