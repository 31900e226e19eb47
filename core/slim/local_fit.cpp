#include "core/slim/local_fit.h"

#include <Eigen/Cholesky>

namespace migiwa {

namespace {

/// Errors count up to this many radii from the centre: beyond, the weight is under 0.02 and neighbouring
/// balls speak.
constexpr float kErrorReach = 0.7F;

template <int Terms>
using Row = Eigen::Matrix<double, Terms, 1>;

template <int Terms>
Row<Terms> rowAt(double u, double v) {
  Row<Terms> row;
  row[0] = 1, row[1] = u, row[2] = v;
  if constexpr (Terms > 3) row[3] = u * u, row[4] = u * v, row[5] = v * v;
  if constexpr (Terms > 6) row[6] = u * u * u, row[7] = u * u * v, row[8] = u * v * v, row[9] = v * v * v;
  return row;
}

/// Coefficients over lengths in radii, in the node's frame.
template <int Terms>
Row<Terms> solve(std::span<const OrientedPoint> points, std::span<const std::uint32_t> indices,
                 const SlimNode& node) {
  const Vec3f bitangent = node.bitangent();
  const float inverse = 1 / node.radius;
  Eigen::Matrix<double, Terms, Terms> matrix = Eigen::Matrix<double, Terms, Terms>::Zero();
  Row<Terms> right = Row<Terms>::Zero();
  for (const std::uint32_t index : indices) {
    const Vec3f q = (points[index].position - node.centre) * inverse;
    const auto weight = static_cast<double>(slimWeight(q.squaredNorm()));
    const Row<Terms> row =
        rowAt<Terms>(static_cast<double>(node.tangent.dot(q)), static_cast<double>(bitangent.dot(q)));
    const Row<Terms> scaled = weight * row;
    // The lower triangle is enough.
    for (int column = 0; column < Terms; ++column)
      matrix.col(column).tail(Terms - column) += scaled[column] * row.tail(Terms - column);
    right += static_cast<double>(node.normal.dot(q)) * scaled;
  }
  // Where the points do not tell all terms apart, the smallest ones are taken.
  const double trace = matrix.diagonal().sum();
  matrix.diagonal().array() += 1e-9 * trace + 1e-30;
  return matrix.template selfadjointView<Eigen::Lower>().ldlt().solve(right);
}

template <int Terms>
void fit(std::span<const OrientedPoint> points, std::span<const std::uint32_t> indices, SlimNode& node) {
  constexpr int kMostTurns = Terms > 3 ? 2 : 1;
  Row<Terms> c;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    c = solve<Terms>(points, indices, node);
    const double tilt = std::hypot(c[1], c[2]);
    // A frame along the fitted normal at the centre keeps |grad f| near 1.
    if (turn + 1 < kMostTurns && tilt < 0.02) break;
    if (turn + 1 < kMostTurns || Terms == 3) {
      const Vec3f turned =
          node.normal - static_cast<float>(c[1]) * node.tangent - static_cast<float>(c[2]) * node.bitangent();
      node.normal = turned.normalized();
      node.tangent = tangentOf(node.normal);
      if (Terms == 3) c = Row<Terms>::Unit(0) * (c[0] / std::sqrt(1 + tilt * tilt));  // exact for a plane
    }
  }
  const auto r = static_cast<double>(node.radius);
  const double scales[4] = {r, 1, 1 / r, 1 / (r * r)};
  for (int k = 0; k < Terms; ++k)
    node.coefficients[static_cast<std::size_t>(k)] = static_cast<float>(c[k] * scales[k == 0  ? 0
                                                                                      : k < 3 ? 1
                                                                                      : k < 6 ? 2
                                                                                              : 3]);
}

}  // namespace

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

  Vec3f normal = Vec3f::Zero();
  const float inverse = 1 / radius;
  for (const std::uint32_t index : indices)
    normal += slimWeight(((points[index].position - centre) * inverse).squaredNorm()) * points[index].normal;
  const float length = normal.norm();
  if (!(length > 0)) return result;
  node.normal = normal / length;
  node.tangent = tangentOf(node.normal);
  for (const std::uint32_t index : indices)
    if (points[index].normal.dot(node.normal) <= 0) return result;

  if (degree == 1) fit<3>(points, indices, node);
  if (degree == 2) fit<6>(points, indices, node);
  if (degree == 3) fit<10>(points, indices, node);

  const float reach = kErrorReach * kErrorReach * radius * radius;
  Vec3f gradient;
  for (const std::uint32_t index : indices) {
    const Vec3f& p = points[index].position;
    if ((p - centre).squaredNorm() > reach) continue;
    const float value = slimNodeValue(node, p, gradient);
    node.error = std::max(node.error, std::abs(value) / gradient.norm());
  }
  result.sound = node.normal.allFinite() && std::isfinite(node.error);
  return result;
}

}  // namespace migiwa
