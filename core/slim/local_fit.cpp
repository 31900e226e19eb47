#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "core/base/math.h"
#include "core/slim/node.h"

namespace migiwa {

namespace {

/// Errors count up to this many radii from the centre: beyond, the weight is under 0.02 and
/// neighbouring balls dominate.
constexpr float kErrorReach = 0.7F;

/// Points worked on at a time.
constexpr Eigen::Index kLanes = 4;
using Lanes = Eigen::Array<double, kLanes, 1>;

/// The points of one ball, in radii from its centre, with their weights; filled up to whole blocks with
/// weight zero.
struct BallPoints {
  Eigen::ArrayXf x, y, z, weight;
  std::vector<Vec3f> normals;

  BallPoints(std::span<const OrientedPoint> points, std::span<const std::uint32_t> indices,
             const Vec3f& centre, float radius) {
    const auto count = static_cast<Eigen::Index>(indices.size());
    const Eigen::Index padded = (count + kLanes - 1) / kLanes * kLanes;
    for (Eigen::ArrayXf* values : {&x, &y, &z, &weight}) *values = Eigen::ArrayXf::Zero(padded);
    normals.reserve(indices.size());
    const float inverse = 1 / radius;
    for (Eigen::Index k = 0; k < count; ++k) {
      const OrientedPoint& point = points[indices[static_cast<std::size_t>(k)]];
      const Vec3f q = (point.position - centre) * inverse;
      x[k] = q.x(), y[k] = q.y(), z[k] = q.z();
      weight[k] = slimWeight(q.squaredNorm());
      normals.push_back(point.normal);
    }
  }
  Lanes along(const Vec3f& axis, Eigen::Index from) const {
    return (axis.x() * x.segment<kLanes>(from) + axis.y() * y.segment<kLanes>(from) +
            axis.z() * z.segment<kLanes>(from))
        .cast<double>();
  }
};

/// Place of u^i v^j among the terms of all degrees, in the order of the coefficients.
constexpr int termAt(int i, int j) {
  return (i + j) * (i + j + 1) / 2 + j;
}

template <int Degree>
using Row = Eigen::Matrix<double, slimTerms(Degree), 1>;

/// Coefficients over lengths in radii, in the node's frame. The entries of the normal equations are moments
/// sum weight u^i v^j: far fewer than entries.
template <int Degree>
Row<Degree> solve(const BallPoints& points, const SlimNode& node) {
  constexpr auto kTerms = static_cast<std::size_t>(slimTerms(Degree)),
                 kMoments = static_cast<std::size_t>(slimTerms(2 * Degree));
  const Vec3f bitangent = node.bitangent();
  std::array<Lanes, kMoments> moments;
  std::array<Lanes, kTerms> heights;
  moments.fill(Lanes::Zero());
  heights.fill(Lanes::Zero());
  for (Eigen::Index from = 0; from < points.x.size(); from += kLanes) {
    const Lanes u = points.along(node.tangent, from), v = points.along(bitangent, from),
                w = points.along(node.normal, from);
    std::array<Lanes, kMoments> terms;
    terms[0] = points.weight.segment<kLanes>(from).cast<double>();
    for (int degree = 1; degree <= 2 * Degree; ++degree) {
      terms[static_cast<std::size_t>(termAt(degree, 0))] =
          terms[static_cast<std::size_t>(termAt(degree - 1, 0))] * u;
      for (int j = 1; j <= degree; ++j)
        terms[static_cast<std::size_t>(termAt(degree - j, j))] =
            terms[static_cast<std::size_t>(termAt(degree - j, j - 1))] * v;
    }
    for (std::size_t k = 0; k < kMoments; ++k) moments[k] += terms[k];
    for (std::size_t k = 0; k < kTerms; ++k) heights[k] += terms[k] * w;
  }
  Eigen::Matrix<double, slimTerms(Degree), slimTerms(Degree)> matrix;
  Row<Degree> right;
  for (int degree = 0, row = 0; degree <= Degree; ++degree) {
    for (int j = 0; j <= degree; ++j, ++row) {
      right[row] = heights[static_cast<std::size_t>(row)].sum();
      for (int other = 0, column = 0; other <= Degree; ++other)
        for (int l = 0; l <= other; ++l, ++column)
          matrix(row, column) =
              moments[static_cast<std::size_t>(termAt(degree - j + other - l, j + l))].sum();
    }
  }
  // Where the points do not tell all terms apart, the smallest ones are taken.
  const double trace = matrix.diagonal().sum();
  matrix.diagonal().array() += 1e-9 * trace + 1e-30;
  return matrix.ldlt().solve(right);
}

template <int Degree>
void fit(const BallPoints& points, SlimNode& node) {
  constexpr int kMostTurns = Degree > 1 ? 2 : 1;
  Row<Degree> c;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    c = solve<Degree>(points, node);
    const double tilt = portable::hypot(c[1], c[2]);
    // A frame along the fitted normal at the centre keeps |grad f| near 1.
    if (turn + 1 < kMostTurns && tilt < 0.02) break;
    if (turn + 1 < kMostTurns || Degree == 1) {
      const Vec3f turned =
          node.normal - static_cast<float>(c[1]) * node.tangent - static_cast<float>(c[2]) * node.bitangent();
      node.normal = turned.normalized();
      node.tangent = tangentOf(node.normal);
      if (Degree == 1) c = Row<Degree>::Unit(0) * (c[0] / std::sqrt(1 + tilt * tilt));  // exact for a plane
    }
  }
  const auto r = static_cast<double>(node.radius);
  const double scales[4] = {r, 1, 1 / r, 1 / (r * r)};
  for (int k = 0; k < slimTerms(Degree); ++k)
    node.coefficients[static_cast<std::size_t>(k)] = static_cast<float>(c[k] * scales[k == 0  ? 0
                                                                                      : k < 3 ? 1
                                                                                      : k < 6 ? 2
                                                                                              : 3]);
}

float squaredDistance(const SlimNode& node, const Vec3f& p) {
  Vec3f gradient;
  const float value = slimNodeValue(node, p, gradient);
  return value * value / gradient.squaredNorm();
}

}  // namespace

float slimNodeError(const SlimNode& node, std::span<const OrientedPoint> points,
                    std::span<const std::uint32_t> indices) {
  float largest = 0;
  for (const std::uint32_t index : indices)
    largest = std::max(largest, squaredDistance(node, points[index].position));
  return std::sqrt(largest);
}

float slimNodeValue(const SlimNode& node, const Vec3f& p, Vec3f& gradient) {
  const Vec3f q = p - node.centre, bitangent = node.bitangent();
  const float u = node.tangent.dot(q), v = bitangent.dot(q), w = node.normal.dot(q);
  const auto& c = node.coefficients;
  const float height = c[0] + u * (c[1] + u * (c[3] + u * c[6])) + v * (c[2] + v * (c[5] + v * c[9])) +
                       u * v * (c[4] + u * c[7] + v * c[8]);
  const float du = c[1] + u * (2 * c[3] + 3 * u * c[6]) + v * (c[4] + 2 * u * c[7] + v * c[8]);
  const float dv = c[2] + v * (2 * c[5] + 3 * v * c[9]) + u * (c[4] + u * c[7] + 2 * v * c[8]);
  gradient = node.normal - du * node.tangent - dv * bitangent;
  return w - height;
}

LocalFit fitLocally(std::span<const OrientedPoint> points, std::span<const std::uint32_t> indices,
                    const Vec3f& centre, float radius, int degree) {
  LocalFit result;
  SlimNode& node = result.node;
  node.centre = centre;
  node.radius = radius;
  if (static_cast<int>(indices.size()) < fewestPoints(degree)) return result;

  const BallPoints ball(points, indices, centre, radius);
  Vec3f normal = Vec3f::Zero();
  for (std::size_t k = 0; k < ball.normals.size(); ++k)
    normal += ball.weight[static_cast<Eigen::Index>(k)] * ball.normals[k];
  const float length = normal.norm();
  if (!(length > 0)) return result;
  node.normal = normal / length;
  node.tangent = tangentOf(node.normal);
  for (const Vec3f& each : ball.normals)
    if (each.dot(node.normal) <= 0) return result;

  if (degree == 1) fit<1>(ball, node);
  if (degree == 2) fit<2>(ball, node);
  if (degree == 3) fit<3>(ball, node);

  float largest = 0;
  const float reach = kErrorReach * kErrorReach * radius * radius;
  for (const std::uint32_t index : indices) {
    const Vec3f& p = points[index].position;
    if ((p - centre).squaredNorm() <= reach) largest = std::max(largest, squaredDistance(node, p));
  }
  node.error = std::sqrt(largest);
  result.valid = node.normal.allFinite() && std::isfinite(node.error);
  return result;
}

}  // namespace migiwa
