#include "app/render/ground_shadow.h"

#include <algorithm>
#include <cmath>

namespace migiwa {
namespace {

constexpr int kSize = GroundShadow::kSize;

/// Mean over 2 r + 1 cells along one direction; cells outside count as empty.
void blurLine(const float* from, float* to, std::ptrdiff_t stride, int r) {
  const auto at = [&](int i) { return i < 0 || i >= kSize ? 0.0F : from[i * stride]; };
  float sum = 0;
  for (int i = -r; i < r; ++i) sum += at(i);
  for (int i = 0; i < kSize; ++i) {
    sum += at(i + r);
    to[i * stride] = std::max(sum, 0.0F) / static_cast<float>(2 * r + 1);
    sum -= at(i - r);
  }
}

}  // namespace

void GroundShadow::add(const Float4& place, double area) {
  const double cell = 2 * halfSide() / kSize;
  const Vec3d offset = place.xyz().cast<double>() - ground_.center;
  const double u = (offset.dot(ground_.u) + halfSide()) / cell - 0.5;
  const double v = (offset.dot(ground_.v) + halfSide()) / cell - 0.5;
  if (!(u >= 0 && v >= 0 && u < kSize - 1 && v < kSize - 1)) return;
  const double height = std::max(offset.dot(ground_.up), 0.0);
  const double weight = area / (cell * cell) * std::exp(-height / (0.12 * ground_.extent));
  const auto x = static_cast<std::size_t>(u), y = static_cast<std::size_t>(v);
  const double fx = u - static_cast<double>(x), fy = v - static_cast<double>(y);
  float* corner = cells_.data() + y * kSize + x;
  corner[0] += static_cast<float>(weight * (1 - fx) * (1 - fy));
  corner[1] += static_cast<float>(weight * fx * (1 - fy));
  corner[kSize] += static_cast<float>(weight * (1 - fx) * fy);
  corner[kSize + 1] += static_cast<float>(weight * fx * fy);
}

std::span<const float> GroundShadow::compute(std::span<const Float4> spheres, float radius,
                                             std::span<const Float4> patches) {
  constexpr std::size_t kCells = static_cast<std::size_t>(kSize) * kSize;
  cells_.assign(kCells, 0);
  scratch_.resize(kCells);
  const double side = 2 * static_cast<double>(radius);
  for (const Float4& sphere : spheres) add(sphere, side * side);
  for (const Float4& patch : patches) add(patch, static_cast<double>(patch.w));
  for (float& c : cells_) c = 1 - std::exp(-1.5F * c);
  // Three means in a row are close to a Gaussian.
  for (int pass = 0; pass < 3; ++pass) {
    for (std::ptrdiff_t i = 0; i < kSize; ++i)
      blurLine(cells_.data() + i * kSize, scratch_.data() + i * kSize, 1, 3);
    for (std::ptrdiff_t i = 0; i < kSize; ++i) blurLine(scratch_.data() + i, cells_.data() + i, kSize, 3);
  }
  return cells_;
}

}  // namespace migiwa
