#include "core/solver/thin_walls.h"

#include <cmath>

namespace migiwa {

std::vector<const Surface*> thinWalls(const Boundary& boundary, float supportRadius) {
  std::vector<const Surface*> thin;
  for (const auto& surface : boundary.surfaces())
    if (surface->thickness() < supportRadius) thin.push_back(surface.get());
  return thin;
}

std::vector<const Surface*> barringWalls(const Boundary& boundary, float supportRadius) {
  std::vector<const Surface*> barring;
  for (const auto& surface : boundary.surfaces())
    if (surface->thinnestPart() < supportRadius) barring.push_back(surface.get());
  for (const auto& wall : boundary.moving())
    if (std::isfinite(wall->thinnestPart()) && wall->thinnestPart() >= supportRadius)
      barring.push_back(wall.get());
  return barring;
}

Vec3f heldBack(const std::vector<const Surface*>& walls, const Vec3f& from, bool stepBegan, const Vec3f& to,
               float margin) {
  Vec3f held = to, normal;
  for (const Surface* wall : walls) {
    const Vec3f start = stepBegan ? wall->carried(from) : from;
    float entry = 0;
    if (held == start || !wall->crosses(start, held, normal, entry)) continue;
    Vec3f ignored;
    if (wall->distance(start, ignored) < 0) continue;
    const Vec3f meets = start + entry * (held - start);
    held += (margin - (held - meets).dot(normal)) * normal;
  }
  return held;
}

void stages::separateNeighbours(StepState& state) {
  const auto seesAllOf = [&](std::size_t i) {
    Vec3f normal;
    for (const Surface* wall : state.thinWalls)
      if (wall->distance(state.current[i].xyz(), normal) < state.supportRadius) return false;
    return true;
  };
  const auto sees = [&](std::size_t i, std::size_t j) {
    Vec3f normal;
    float entry = 0;
    for (const Surface* wall : state.thinWalls)
      if (wall->crosses(state.current[i].xyz(), state.current[j].xyz(), normal, entry)) return false;
    return true;
  };
  parallelFor(state.pool, state.particles.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      if (!seesAllOf(i)) state.neighbours.keep(i, [&](std::size_t j) { return sees(i, j); });
  });
}

}  // namespace migiwa
