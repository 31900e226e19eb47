#include "core/slim/points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/math.h"

namespace migiwa {

namespace {

constexpr double kPointsPerCell = 4;
constexpr std::size_t kFewest = 64;  // points of the coarsest level

CellCoordinates cellOf(const Vec3f& p, float inverseCell) {
  return {cellAlong(p.x() * inverseCell), cellAlong(p.y() * inverseCell), cellAlong(p.z() * inverseCell)};
}

}  // namespace

Bounds TriangleMesh::bounds() const {
  Bounds bounds;
  for (const Vec3f& vertex : vertices) bounds.include(vertex.cast<double>());
  return bounds;
}

NearPoints::NearPoints(std::vector<Vec3f> points, double reach)
    : reach_(reach), points_(std::move(points)), order_(points_.size()) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> cells(points_.size());
  for (std::size_t k = 0; k < cells.size(); ++k)
    cells[k] = {keyOf(cellOf(points_[k])), static_cast<std::uint32_t>(k)};
  std::sort(cells.begin(), cells.end());
  std::vector<std::uint64_t> keys(cells.size());
  std::vector<Vec3f> sorted(cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k)
    keys[k] = cells[k].first, order_[k] = cells[k].second, sorted[k] = points_[order_[k]];
  points_ = std::move(sorted);
  hash_.build(keys);
}

NearPoints::Cell NearPoints::cellOf(const Vec3f& p) const {
  return (p.cast<double>() / reach_).unaryExpr([](double x) { return std::floor(x); }).cast<std::int64_t>();
}

PointLevels::PointLevels(const std::vector<OrientedPoint>& points) : points_(points) {
  RandomSequence random(1);
  for (std::size_t k = points_.size(); k > 1; --k)
    std::swap(points_[k - 1], points_[static_cast<std::size_t>(random.below(k))]);
  if (points_.empty()) return;

  Bounds bounds;
  for (const OrientedPoint& point : points_) bounds.include(point.position.cast<double>());
  const double extent = std::max(bounds.size().maxCoeff(), 1e-6);
  // Points lie on a surface: the number in an occupied cell goes with the square of the edge.
  double cell = extent / std::sqrt(static_cast<double>(points_.size()) / kPointsPerCell);
  const double smallest = extent * 4e-6;
  levels_.emplace_back();
  for (int round = 0; round < 4; ++round) {
    cell = std::clamp(cell, smallest, extent);
    const double mean = build(levels_[0], points_.size(), static_cast<float>(cell));
    if (std::abs(mean / kPointsPerCell - 1) < 0.2) break;
    if (round < 3) cell *= std::sqrt(kPointsPerCell / mean);
  }
  // A smooth surface meets about 1.5 cells of a grid in an area of one cell's face.
  spacing_ = static_cast<float>(cell / std::sqrt(1.5 * kPointsPerCell));
  for (std::size_t count = points_.size() / 4; count >= kFewest; count /= 4) {
    cell *= 2;
    levels_.emplace_back();
    build(levels_.back(), count, static_cast<float>(cell));
  }
}

double PointLevels::build(Level& level, std::size_t count, float cell) const {
  level.inverseCell = 1 / cell;
  std::vector<std::uint64_t> keys(count);
  for (std::size_t k = 0; k < count; ++k) keys[k] = cellKey(cellOf(points_[k].position, level.inverseCell));
  level.order.resize(count);
  std::iota(level.order.begin(), level.order.end(), 0U);
  std::sort(level.order.begin(), level.order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  std::vector<std::uint64_t> sorted(count);
  level.positions.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    sorted[k] = keys[level.order[k]];
    level.positions[k] = points_[level.order[k]].position;
  }
  level.hash.build(sorted);
  return static_cast<double>(count) / static_cast<double>(level.hash.cells());
}

void PointLevels::within(const Vec3f& centre, float radius, float wanted,
                         std::vector<std::uint32_t>& out) const {
  const float expected = std::numbers::pi_v<float> * radius * radius / (spacing_ * spacing_);
  std::size_t level = 0;
  for (float left = expected / 4; left >= wanted && level + 1 < levels_.size(); left /= 4) ++level;
  collect(levels_[level], centre, radius, out);
}

void PointLevels::withinAll(const Vec3f& centre, float radius, std::vector<std::uint32_t>& out) const {
  collect(levels_[0], centre, radius, out);
}

void PointLevels::collect(const Level& level, const Vec3f& centre, float radius,
                          std::vector<std::uint32_t>& out) const {
  out.clear();
  const float squared = radius * radius;
  const auto take = [&](std::size_t k) {
    if ((level.positions[k] - centre).squaredNorm() < squared) out.push_back(level.order[k]);
  };
  const CellCoordinates low = cellOf(centre - Vec3f::Constant(radius), level.inverseCell);
  const CellCoordinates high = cellOf(centre + Vec3f::Constant(radius), level.inverseCell);
  const double box =
      (double(high.x) - low.x + 1) * (double(high.y) - low.y + 1) * (double(high.z) - low.z + 1);
  if (box > 2 * static_cast<double>(level.order.size())) {
    for (std::size_t k = 0; k < level.order.size(); ++k) take(k);
    return;
  }
  for (std::int32_t z = low.z; z <= high.z; ++z) {
    for (std::int32_t y = low.y; y <= high.y; ++y) {
      for (std::int32_t x = low.x; x <= high.x; ++x) {
        const CellHash::Range range = level.hash.find(cellKey({x, y, z}));
        for (std::uint32_t k = range.begin; k < range.end; ++k) take(k);
      }
    }
  }
}

void CellHash::build(const std::vector<std::uint64_t>& sortedKeys) {
  cells_ = 0;
  for (std::size_t k = 0; k < sortedKeys.size(); ++k)
    if (k == 0 || sortedKeys[k] != sortedKeys[k - 1]) ++cells_;
  // At most half full: a search ends after a step or two.
  slots_.assign(cells_ == 0 ? 0 : std::bit_ceil(2 * cells_), {});
  if (slots_.empty()) return;
  mask_ = slots_.size() - 1;
  for (std::size_t begin = 0; begin < sortedKeys.size();) {
    std::size_t end = begin;
    while (end < sortedKeys.size() && sortedKeys[end] == sortedKeys[begin]) ++end;
    std::size_t slot = hash(sortedKeys[begin]) & mask_;
    while (slots_[slot].key != kEmpty) slot = (slot + 1) & mask_;
    slots_[slot] = {sortedKeys[begin], {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)}};
    begin = end;
  }
}

std::size_t sampleCount(const TriangleMesh& mesh, int nodes) {
  // Small balls hold a dozen triangles' worth of surface each and overlap eightfold; every one needs a few
  // dozen points.
  const std::size_t forNodes = 12 * static_cast<std::size_t>(std::max(nodes, 0));
  return std::clamp(std::max(4 * mesh.triangles.size(), forNodes), std::size_t{200000}, std::size_t{2000000});
}

std::vector<OrientedPoint> samplePoints(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<Vec3f> normals(mesh.triangles.size());
  std::vector<double> areas(mesh.triangles.size());
  double total = 0;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const auto& [a, b, c] = mesh.triangles[k];
    const Vec3d across = (mesh.vertices[b] - mesh.vertices[a])
                             .cast<double>()
                             .cross((mesh.vertices[c] - mesh.vertices[a]).cast<double>());
    areas[k] = 0.5 * across.norm();
    total += areas[k];
    normals[k] = across.normalized().cast<float>();
  }
  std::vector<OrientedPoint> points;
  if (!(total > 0)) return points;
  points.reserve(count + mesh.triangles.size() / 2);
  RandomSequence random(seed);
  // A point each time the area passed reaches the next multiple of a share, so that neighbouring triangles of
  // a strip share them evenly.
  const double share = total / static_cast<double>(count);
  double next = random.unit() * share, passed = 0;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const auto& [a, b, c] = mesh.triangles[k];
    passed += areas[k];
    // Roberts' R2 sequence, begun at random, folded into the triangle.
    double u = random.unit(), v = random.unit();
    for (; next < passed; next += share) {
      u += 0.7548776662466927, v += 0.5698402909980532;
      u -= std::floor(u), v -= std::floor(v);
      const bool folded = u + v > 1;
      const auto s = static_cast<float>(folded ? 1 - u : u), t = static_cast<float>(folded ? 1 - v : v);
      points.push_back({mesh.vertices[a] + s * (mesh.vertices[b] - mesh.vertices[a]) +
                            t * (mesh.vertices[c] - mesh.vertices[a]),
                        normals[k]});
    }
  }
  return points;
}

}  // namespace migiwa
