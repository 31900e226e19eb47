// One ball of a SLIM surface and the polynomial that stands for the surface in it ([OBA] Ohtake, Belyaev and
// Alexa 2005, Sparse low-degree implicit surfaces): in a frame at the ball's centre with w along the normal,
//   f(p) = w - sum c_k u^i v^j,   i + j <= degree,
// zero on the surface, positive where the normal points, with |grad f| about 1 near the centre.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include <Eigen/Geometry>

#include "core/base/math.h"
#include "core/slim/points.h"

namespace migiwa {

/// Coefficients of a polynomial in u and v: 1, u, v, u^2, uv, v^2, u^3, u^2 v, u v^2, v^3.
inline constexpr int kSlimTerms = 10;
inline constexpr int kLargestSlimDegree = 3;
/// Part of a ball's radius, its core: every point of the surface lies in the core of some ball, where that
/// has a weight of at least 0.08.
inline constexpr float kSlimCore = 0.55F;
/// Largest radius of a fitted ball, in diagonals of the shape.
inline constexpr double kLargestSlimRadius = 0.25;
constexpr int slimTerms(int degree) {
  return (degree + 1) * (degree + 2) / 2;
}

struct SlimNode {
  Vec3f centre = Vec3f::Zero();                     ///< (m)
  float radius = 0;                                 ///< of the ball (m)
  Vec3f normal = Vec3f::UnitZ();                    ///< unit; the frame's w axis
  Vec3f tangent = Vec3f::UnitX();                   ///< unit, across the normal; the frame's u axis
  std::array<float, kSlimTerms> coefficients = {};  ///< (m^(1 - i - j)); zero beyond the degree
  float error = 0;  ///< largest |f| at the points that the polynomial was fitted to (m)

  Vec3f bitangent() const { return normal.cross(tangent); }
};

/// Weight of a node at the squared distance t^2 from its centre, in radii: exp(-8 t^2) up to half the radius,
/// then 16 e^-2 (1 - t)^4, and zero from the radius on. C1.
inline float slimWeight(float squared) {
  if (squared >= 1) return 0;
  if (squared < 0.25F) {
    // exp(-x) for x in [0, 2] as the eighth power of a short series: within 3e-6, and the same on every
    // processor.
    const float y = -squared;
    const float root = 1 + y * (1 + y * (0.5F + y * (1.0F / 6 + y * (1.0F / 24 + y * (1.0F / 120)))));
    const float second = root * root, fourth = second * second;
    return fourth * fourth;
  }
  const float rest = 1 - std::sqrt(squared), second = rest * rest;
  return 2.1653645317858030F * second * second;  // 16 e^-2
}

/// d weight / d (t^2).
inline float slimWeightSlope(float squared, float weight) {
  if (squared >= 1) return 0;
  if (squared < 0.25F) return -8 * weight;
  const float t = std::sqrt(squared), rest = 1 - t;
  return -4.3307290635716060F * rest * rest * rest / t;  // -4 * 16 e^-2 (1 - t)^3 / (2 t)
}

/// A unit vector across a unit normal, the same for the same normal everywhere.
inline Vec3f tangentOf(const Vec3f& normal) {
  // Duff et al. 2017, Building an orthonormal basis, revisited.
  const float sign = std::copysign(1.0F, normal.z());
  const float a = -1 / (sign + normal.z());
  return {1 + sign * normal.x() * normal.x() * a, sign * normal.x() * normal.y() * a, -sign * normal.x()};
}

// The polynomial of one ball, by weighted least squares over the points in it.

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
  bool valid = false;  ///< enough points, whose normals all lie within 90 degrees of their mean
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
