// The water of a picture as one closed surface: its faces to the air, and behind the walls that it touches
// what closes it there.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "app/raytrace/stage.h"

namespace migiwa {
namespace {

/// How far behind the walls that it touches the water is closed, in particle spacings: farther than the
/// water's faces to walls, and the drawn triangles of a wall, are off the wall itself.
constexpr float kBehind = 0.5F;
/// What is nearer to a wall touches it, in particle spacings.
constexpr float kTouching = 0.05F;
/// Faces to walls that turn by less than this at a vertex are one side of it (cosine).
constexpr float kOneSide = 0.85F;

using Corners = std::array<std::uint32_t, 3>;

/// Sides that the wall around a vertex has: unit normals, into the wall.
struct WallSides {
  std::array<Vec3f, 4> normals;
  int count = 0;

  void add(const Vec3f& normal) {
    for (int k = 0; k < count; ++k)
      if (normals[static_cast<std::size_t>(k)].dot(normal) > kOneSide) return;
    if (count < static_cast<int>(normals.size())) normals[static_cast<std::size_t>(count++)] = normal;
  }
  /// A step that goes behind none of them by more than 1, and behind each by 1 where they are square to each
  /// other.
  Vec3f step() const {
    Vec3f sum = Vec3f::Zero();
    for (int k = 0; k < count; ++k) sum += normals[static_cast<std::size_t>(k)];
    float most = 1;
    for (int k = 0; k < count; ++k) most = std::max(most, sum.dot(normals[static_cast<std::size_t>(k)]));
    return sum / most;
  }
};

}  // namespace

/// Distance (m) to a body's wall, or to the ground.
float Stage::distanceTo(std::size_t body, const Vec3f& p) const {
  if (body >= shown_.size()) return std::abs((p - groundPoint_).dot(up_));
  Vec3f ignored;
  return std::abs(shown_[body]->distance(p, ignored));
}

/// Whether what touches the water at p is shown.
bool Stage::showsWet(const Vec3f& p) const {
  float shown = std::numeric_limits<float>::infinity(), hidden = shown;
  for (std::size_t body = 0; body < bodies_.size(); ++body) shown = std::min(shown, distanceTo(body, p));
  if (shown < kTouching * spacing_) return true;
  Vec3f ignored;
  for (const Surface* wall : hidden_) hidden = std::min(hidden, std::abs(wall->distance(p, ignored)));
  return shown <= hidden;
}

/// How far behind the walls at p the water ends (m): within what they are made of.
float Stage::depthBehind(const Vec3f& p) const {
  float depth = kBehind * spacing_;
  for (std::size_t body = 0; body < shown_.size(); ++body)
    if (distanceTo(body, p) < depth)
      depth = std::min({depth, 0.4F * shown_[body]->thinnestPart(), 0.9F * glassThickness()});
  return depth;
}

void Stage::addWater(const StageContent& content) {
  const SurfaceMesh& water = *content.water;
  TriangleMesh closed{water.positions, {}};
  std::vector<Corners> wet;
  for (std::size_t k = 0; k < water.triangles.size(); ++k) {
    const Corners& corners = water.triangles[k];
    const Vec3f middle =
        (water.positions[corners[0]] + water.positions[corners[1]] + water.positions[corners[2]]) / 3;
    (water.wet[k] != 0 && showsWet(middle) ? wet : closed.triangles).push_back(corners);
  }
  normals_ = water.normals;

  // The faces to walls go behind them, each vertex away from every side of the wall that is there.
  std::map<std::uint32_t, WallSides> sides;
  for (const auto& [a, b, c] : wet) {
    const Vec3f normal =
        (water.positions[b] - water.positions[a]).cross(water.positions[c] - water.positions[a]);
    if (!(normal.norm() > 0)) continue;
    for (const std::uint32_t corner : {a, b, c}) sides[corner].add(normal.normalized());
  }
  std::map<std::uint32_t, std::uint32_t> moved;
  // A vertex behind the wall, and after it the same one for free faces that end there, which have other
  // normals.
  const auto behind = [&](std::uint32_t vertex) {
    const auto [place, isNew] = moved.try_emplace(vertex, static_cast<std::uint32_t>(closed.vertices.size()));
    if (!isNew) return place->second;
    const Vec3f p = water.positions[vertex], step = sides[vertex].step();
    closed.vertices.insert(closed.vertices.end(), 2, p + depthBehind(p) * step);
    normals_.push_back(step.norm() > 0 ? Vec3f(step.normalized()) : water.normals[vertex]);
    normals_.push_back(water.normals[vertex]);
    return place->second;
  };

  // Where water, air and wall meet, the free faces' edges are joined to those behind the wall.
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> wetEdges;
  for (const Corners& corners : wet)
    for (std::size_t k = 0; k < 3; ++k) wetEdges[{corners[k], corners[(k + 1) % 3]}] = true;
  const std::size_t count = closed.triangles.size();
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t a = closed.triangles[k][side], b = closed.triangles[k][(side + 1) % 3];
      if (!wetEdges.contains({b, a})) continue;
      const std::uint32_t c = behind(a) + 1, d = behind(b) + 1;
      closed.triangles.push_back({b, a, c});
      closed.triangles.push_back({b, c, d});
    }
  }
  for (const auto& [a, b, c] : wet) {
    const std::uint32_t i = behind(a), j = behind(b), k = behind(c);
    closed.triangles.push_back({i, j, k});
  }
  triangles_ = closed.triangles;
  water_ = TriangleRays(closed);
}

}  // namespace migiwa
