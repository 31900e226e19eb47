#include <cmath>

#include <Eigen/Geometry>

#include "core/gamma/half_spaces.h"

namespace migiwa {

namespace {

/// Nearer than that to a plane a corner lies on it.
constexpr float kOnPlane = 1e-6F;

float rounded(float height) {
  return std::abs(height) < kOnPlane ? 0.0F : height;
}

/// The part where sign * plane >= 0.
Polygon partOf(const Polygon& polygon, const std::array<float, Polygon::kMost>& heights, float sign) {
  Polygon part;
  for (int k = 0; k < polygon.count; ++k) {
    const int next = k + 1 == polygon.count ? 0 : k + 1;
    const float here = sign * heights[static_cast<std::size_t>(k)],
                there = sign * heights[static_cast<std::size_t>(next)];
    if (here >= 0) part.add(polygon.corner(k));
    if ((here > 0 && there < 0) || (here < 0 && there > 0))
      part.add(polygon.corner(k) + here / (here - there) * (polygon.corner(next) - polygon.corner(k)));
  }
  return part;
}

std::array<float, Polygon::kMost> heightsOver(const Polygon& polygon, const CutPlane& plane) {
  std::array<float, Polygon::kMost> heights;
  for (int k = 0; k < polygon.count; ++k)
    heights[static_cast<std::size_t>(k)] = rounded(plane.at(polygon.corner(k)));
  return heights;
}

}  // namespace

PlaneSide sideOf(const Polygon& polygon, const CutPlane& plane) {
  bool above = false, below = false;
  for (int k = 0; k < polygon.count; ++k) {
    const float height = rounded(plane.at(polygon.corner(k)));
    above = above || height > 0;
    below = below || height < 0;
  }
  if (!below || (above && polygon.count == Polygon::kMost)) return PlaneSide::inside;
  return above ? PlaneSide::across : PlaneSide::outside;
}

void clip(Polygon& polygon, const CutPlane& plane) {
  switch (sideOf(polygon, plane)) {
    case PlaneSide::inside:
      return;
    case PlaneSide::outside:
      polygon.count = 0;
      return;
    case PlaneSide::across:
      polygon = partOf(polygon, heightsOver(polygon, plane), 1);
  }
}

ViewCone::ViewCone(const Polygon& polygon, const Vec3f& normal, float distance) {
  for (int k = 0; k < polygon.count; ++k) {
    const Vec3f across = polygon.corner(k).cross(polygon.corner(k + 1));
    const float length = across.norm();
    // An edge that points at the origin is seen as a corner.
    if (length > 1e-9F) planes_[static_cast<std::size_t>(count_++)] = {-across / length, 0};
  }
  planes_[static_cast<std::size_t>(count_++)] = {-normal, -distance};
}

bool ViewCone::subtractFrom(const Polygon& polygon, std::vector<Polygon>& left) const {
  for (int k = 0; k < count_; ++k)
    if (sideOf(polygon, planes_[static_cast<std::size_t>(k)]) == PlaneSide::outside) return false;
  const std::size_t before = left.size();
  Polygon rest = polygon;
  for (int k = 0; k < count_; ++k) {
    const CutPlane& plane = planes_[static_cast<std::size_t>(k)];
    switch (sideOf(rest, plane)) {
      case PlaneSide::inside:
        break;
      case PlaneSide::outside:
        left.resize(before);
        return false;
      case PlaneSide::across: {
        const std::array<float, Polygon::kMost> heights = heightsOver(rest, plane);
        left.push_back(partOf(rest, heights, -1));
        rest = partOf(rest, heights, 1);
      }
    }
  }
  return true;
}

}  // namespace migiwa
