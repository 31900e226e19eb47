#include <algorithm>
#include <cmath>

#include "core/slim/model.h"
#include "core/walls/triangles.h"

namespace migiwa {

namespace {

/// So much the sides of a triangle are let out that rays between two of them hit one.
constexpr float kSlack = 1e-5F;
/// A triangle that fills a wider cone than that is met with all directions.
constexpr float kWidest = 0.2F;

FourFloats dot(const Vec3f& v, const DirectionBins::Bin& w) {
  return v.x() * w.x + v.y() * w.y + v.z() * w.z;
}

}  // namespace

SeenTriangle seenFrom(const Vec3f& origin, const WallTriangle& triangle, bool behind) {
  constexpr float kLeast = 1e-9F;
  const float sign = behind ? -1.0F : 1.0F;
  const std::array<Vec3f, 3> to{triangle.corners[0] - origin, triangle.corners[1] - origin,
                                triangle.corners[2] - origin};
  SeenTriangle seen;
  seen.inverse = -sign / std::max(-sign * triangle.normal.dot(to[0]), kLeast) * triangle.normal;
  std::array<Vec3f, 3> units;
  seen.axis.setZero();
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3f side = -sign * to[k].cross(to[(k + 1) % 3]);
    const float length = side.norm();
    if (length > 0) side /= length;
    seen.sides[k] = side - kSlack * sign * triangle.normal;
    units[k] = to[k].normalized();
    seen.axis += units[k];
  }
  seen.axis.normalize();
  seen.cosine = std::min({seen.axis.dot(units[0]), seen.axis.dot(units[1]), seen.axis.dot(units[2])}) - 1e-4F;
  return seen;
}

void hitTriangles(std::span<const SeenTriangle> triangles, const Directions& directions,
                  std::span<float> hits) {
  if (triangles.empty()) return;
  thread_local DirectionBins bins;
  // By 1 / distance: a ray that runs along a triangle divides by nothing.
  thread_local std::vector<FourFloats> inverse;
  const DirectionSet set{directions.x, directions.y, directions.z};
  if (!bins.matches(set)) bins.build(set);
  const std::span<const DirectionBins::Bin> all = bins.bins();
  inverse.assign(all.size(), FourFloats{});
  const auto hit = [&](const SeenTriangle& triangle, const DirectionBins::Bin& bin) {
    FourFloats& nearest = inverse[static_cast<std::size_t>(&bin - all.data())];
    const FourFloats towards = dot(triangle.inverse, bin), one = dot(triangle.sides[0], bin),
                     two = dot(triangle.sides[1], bin), three = dot(triangle.sides[2], bin);
    const auto passes = (one >= 0.0F) & (two >= 0.0F) & (three >= 0.0F) & (towards > nearest);
    nearest = passes ? towards : nearest;
  };
  for (const SeenTriangle& triangle : triangles) {
    if (triangle.cosine < kWidest) {
      for (const DirectionBins::Bin& bin : all) hit(triangle, bin);
    } else {
      bins.visitCone(triangle.axis, triangle.cosine, std::sqrt(1 - triangle.cosine * triangle.cosine),
                     [&](const DirectionBins::Bin& bin) { hit(triangle, bin); });
    }
  }
  for (std::size_t k = 0; k < all.size(); ++k)
    for (std::size_t lane = 0; lane < DirectionBins::kLanes; ++lane)
      if (const std::uint32_t index = all[k].index[lane];
          index != DirectionBins::kNone && inverse[k][lane] > 0)
        hits[index] = std::min(hits[index], 1 / inverse[k][lane]);
}

}  // namespace migiwa
