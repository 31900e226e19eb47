// The polynomial of one ball, by weighted least squares over the points in it.
#pragma once

#include <span>

#include "core/slim/oriented_points.h"
#include "core/slim/slim_node.h"

namespace migiwa {

/// Fewest points that a fit of this degree is trusted with.
constexpr int fewestPoints(int degree) {
  return degree == 1 ? 12 : degree == 2 ? 18 : 28;
}

/// Points that a fit of this degree has at least where there are enough.
constexpr float wantedPoints(int degree) {
  return degree == 1 ? 40 : degree == 2 ? 60 : 90;
}

struct LocalFit {
  SlimNode node;
  bool sound = false;  ///< enough points, whose normals all lie within 90 degrees of their mean
};

/// Fits the ball at `centre` with the given radius (m) to those of `points` that `indices` names.
LocalFit fitLocally(std::span<const OrientedPoint> points, std::span<const std::uint32_t> indices,
                    const Vec3f& centre, float radius, int degree);

/// Largest distance (m) of a node's polynomial to those points that `indices` names.
float slimNodeError(const SlimNode& node, std::span<const OrientedPoint> points,
                    std::span<const std::uint32_t> indices);

/// f of a node at p (m), and its gradient.
float slimNodeValue(const SlimNode& node, const Vec3f& p, Vec3f& gradient);

}  // namespace migiwa
