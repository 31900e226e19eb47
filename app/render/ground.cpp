#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "app/render/passes.h"

namespace migiwa {
namespace {

/// The largest of 1, 2 and 5 times a power of ten that is not above `value`.
double roundDown125(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  const double digits = value / power;
  return (digits >= 5 ? 5 : digits >= 2 ? 2 : 1) * power;
}

}  // namespace

Ground makeGround(const Bounds& scene, const Vec3d& up) {
  Ground ground;
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  ground.up = Vec3d::Unit(axis) * (up[axis] < 0 ? -1 : 1);
  ground.u = Vec3d::Unit((axis + 1) % 3);
  ground.v = ground.up.cross(ground.u);
  if (!scene.empty()) {
    ground.extent = std::max(scene.size().maxCoeff(), 1e-3);
    ground.center = scene.center();
    ground.center[axis] = up[axis] < 0 ? scene.max[axis] : scene.min[axis];
  }
  ground.halfSide = 3 * ground.extent;
  ground.gridSpacing = roundDown125(ground.extent / 8);
  return ground;
}

GroundPass::GroundPass(const Ground& ground)
    : ground_(ground),
      shadow_(ground),
      background_("background"),
      plane_("ground"),
      shadowMap_(makeTexture(GL_TEXTURE_2D)),
      layout_(makeVertexArray()) {
  glTextureStorage2D(shadowMap_.name(), 1, GL_R32F, GroundShadow::kSize, GroundShadow::kSize);
  glTextureParameteri(shadowMap_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(shadowMap_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(shadowMap_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);

  const auto f = [](double v) { return static_cast<float>(v); };
  plane_.set("origin", f(ground_.center.x()), f(ground_.center.y()), f(ground_.center.z()),
             f(ground_.halfSide));
  plane_.set("axisU", f(ground_.u.x()), f(ground_.u.y()), f(ground_.u.z()), 0);
  plane_.set("axisV", f(ground_.v.x()), f(ground_.v.y()), f(ground_.v.z()), 0);
  const double period = 5 * ground_.gridSpacing;
  plane_.set("gridOffset", f(std::fmod(ground_.center.dot(ground_.u), period)),
             f(std::fmod(ground_.center.dot(ground_.v), period)), f(ground_.gridSpacing), 0);
  const double half = shadow_.halfSide();
  plane_.set("shadowArea", f(-half), f(-half), f(2 * half), f(2 * half));
}

void GroundPass::draw(std::span<const Float4> spheres, float radius, std::span<const Float4> patches,
                      const Vec3d& eye) {
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDisable(GL_BLEND);
  glBindVertexArray(layout_.name());
  background_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  if (ground_.heightOf(eye) <= 0) return;

  const std::span<const float> shadow = shadow_.compute(spheres, radius, patches);
  glTextureSubImage2D(shadowMap_.name(), 0, 0, 0, GroundShadow::kSize, GroundShadow::kSize, GL_RED, GL_FLOAT,
                      shadow.data());
  glBindTextureUnit(1, shadowMap_.name());
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  plane_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

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
