// The water of a picture: which of its faces are an interface to air, and how they end in the walls.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "app/raytrace/stage.h"

namespace migiwa {
namespace {

/// How far free faces are prolonged into the wall that they end at, in particle spacings: farther than the
/// water's faces to walls cut off a wall's edges.
constexpr float kProlonged = 0.5F;
/// What is nearer to a wall touches it, in particle spacings.
constexpr float kTouching = 0.05F;

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

/// The faces to each body, by the vertices that are on it.
void Stage::addLabels(const SurfaceMesh& water, const std::vector<std::array<std::uint32_t, 3>>& wet) {
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    std::vector<std::uint8_t> touches(water.positions.size(), 2);
    TriangleMesh faces{water.positions, {}};
    for (const auto& corners : wet) {
      const bool any = std::any_of(corners.begin(), corners.end(), [&](std::uint32_t corner) {
        if (touches[corner] > 1)
          touches[corner] = distanceTo(body, water.positions[corner]) < kTouching * spacing_ ? 1 : 0;
        return touches[corner] != 0;
      });
      if (any) faces.triangles.push_back(corners);
    }
    wet_.emplace_back(faces);
  }
}

void Stage::addWater(const StageContent& content) {
  const SurfaceMesh& water = *content.water;
  TriangleMesh free{water.positions, {}};
  std::vector<std::array<std::uint32_t, 3>> wet;
  for (std::size_t k = 0; k < water.triangles.size(); ++k) {
    const auto& corners = water.triangles[k];
    const Vec3f middle =
        (water.positions[corners[0]] + water.positions[corners[1]] + water.positions[corners[2]]) / 3;
    (water.wet[k] != 0 && showsWet(middle) ? wet : free.triangles).push_back(corners);
  }
  addLabels(water, wet);
  normals_ = water.normals;

  // Edges of wet faces; those that a free face has the other way round are where water, air and wall meet.
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> wetEdges;
  for (const auto& corners : wet)
    for (std::size_t k = 0; k < 3; ++k) wetEdges[{corners[k], corners[(k + 1) % 3]}] = true;
  std::map<std::uint32_t, std::uint32_t> prolonged;
  const auto below = [&](std::uint32_t vertex) {
    const auto [place, isNew] =
        prolonged.try_emplace(vertex, static_cast<std::uint32_t>(free.vertices.size()));
    if (!isNew) return place->second;
    const Vec3f& p = water.positions[vertex];
    std::size_t nearest = 0;
    for (std::size_t body = 1; body < bodies_.size(); ++body)
      if (distanceTo(body, p) < distanceTo(nearest, p)) nearest = body;
    Vec3f normal = up_;
    float depth = kProlonged * spacing_;
    if (nearest < shown_.size()) {
      shown_[nearest]->distance(p, normal);
      depth = std::min({depth, 0.4F * shown_[nearest]->thinnestPart(), 0.9F * glassThickness()});
    }
    free.vertices.emplace_back(p - depth * normal);
    normals_.push_back(water.normals[vertex]);
    return place->second;
  };
  const std::size_t count = free.triangles.size();
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t a = free.triangles[k][side], b = free.triangles[k][(side + 1) % 3];
      if (!wetEdges.contains({b, a})) continue;
      const std::uint32_t c = below(a), d = below(b);
      free.triangles.push_back({b, a, c});
      free.triangles.push_back({b, c, d});
    }
  }
  triangles_ = free.triangles;
  water_ = TriangleRays(free);
}

}  // namespace migiwa
