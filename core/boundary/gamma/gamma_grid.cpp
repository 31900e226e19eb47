#include "core/boundary/gamma/gamma_grid.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/boundary/gamma/gamma_grid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE void interpolateAt(const float* HWY_RESTRICT block, const Vec3f& at,
                              const std::array<int, 3>& cell, float toGradient, GammaSample& sample) {
  using D = hn::CappedTag<float, 8>;
  const D d;
  constexpr std::size_t kParts = 8 / hn::MaxLanes(d);
  const SplineWeights wx(at.x()), wy(at.y()), wz(at.z());
  constexpr int kRow = 2 * GammaGrid::kNodes, kLayer = kRow * GammaGrid::kNodes;
  const float* from = block + cell[2] * kLayer + cell[1] * kRow + 2 * cell[0];
  // Four nodes of a row are eight floats: both kernels at once.
  alignas(32) float value[8], alongY[8], alongZ[8];
  for (std::size_t part = 0; part < kParts; ++part) {
    auto v = hn::Zero(d), y = v, z = v;
    for (int k = 0; k < 4; ++k) {
      const float* row = from + k * kLayer + part * hn::MaxLanes(d);
      const auto r0 = hn::LoadU(d, row), r1 = hn::LoadU(d, row + kRow), r2 = hn::LoadU(d, row + 2 * kRow),
                 r3 = hn::LoadU(d, row + 3 * kRow);
      const auto flat = hn::MulAdd(
          hn::Set(d, wy.value[3]), r3,
          hn::MulAdd(hn::Set(d, wy.value[2]), r2,
                     hn::MulAdd(hn::Set(d, wy.value[1]), r1, hn::Mul(hn::Set(d, wy.value[0]), r0))));
      const auto steep = hn::MulAdd(
          hn::Set(d, wy.slope[3]), r3,
          hn::MulAdd(hn::Set(d, wy.slope[2]), r2,
                     hn::MulAdd(hn::Set(d, wy.slope[1]), r1, hn::Mul(hn::Set(d, wy.slope[0]), r0))));
      v = hn::MulAdd(hn::Set(d, wz.value[k]), flat, v);
      y = hn::MulAdd(hn::Set(d, wz.value[k]), steep, y);
      z = hn::MulAdd(hn::Set(d, wz.slope[k]), flat, z);
    }
    hn::Store(v, d, value + part * hn::MaxLanes(d));
    hn::Store(y, d, alongY + part * hn::MaxLanes(d));
    hn::Store(z, d, alongZ + part * hn::MaxLanes(d));
  }
  float gamma = 0;
  Vec3f gradient = Vec3f::Zero(), pairGradient = Vec3f::Zero();
  for (int k = 0; k < 4; ++k) {
    gamma += wx.value[k] * value[2 * k];
    gradient += Vec3f(wx.slope[k] * value[2 * k], wx.value[k] * alongY[2 * k], wx.value[k] * alongZ[2 * k]);
    pairGradient += Vec3f(wx.slope[k] * value[2 * k + 1], wx.value[k] * alongY[2 * k + 1],
                          wx.value[k] * alongZ[2 * k + 1]);
  }
  // Where the spline swings past the ends of the range gamma stays at the end, and does not change.
  sample.gamma = std::clamp(gamma, 0.0F, 1.0F);
  sample.gradient = sample.gamma == gamma ? Vec3f(toGradient * gradient) : Vec3f(Vec3f::Zero());
  sample.pairGradient = toGradient * pairGradient;
}

void interpolateBatch(const GammaGrid& grid, float supportRadius, std::span<const Float4> points,
                      std::span<const std::int32_t> blocks, std::span<GammaSample> out) {
  const float toGradient = supportRadius / grid.cell;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (blocks[i] < 0) continue;
    Vec3f at = (points[i].xyz() - grid.origin) / grid.cell;  // as blockAt() has it, to the last bit
    std::array<int, 3> cell{};
    for (int axis = 0; axis < 3; ++axis) {
      const int whole = static_cast<int>(at[axis]);
      at[axis] -= static_cast<float>(whole);
      cell[static_cast<std::size_t>(axis)] = whole % GammaGrid::kCells;
    }
    interpolateAt(&grid.coefficients[static_cast<std::size_t>(blocks[i]) * GammaGrid::kBlockFloats], at, cell,
                  toGradient, out[i]);
  }
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(interpolateBatch);

void interpolate(const GammaGrid& grid, float supportRadius, std::span<const Float4> points,
                 std::span<const std::int32_t> blocks, std::span<GammaSample> out) {
  HWY_DYNAMIC_DISPATCH(interpolateBatch)(grid, supportRadius, points, blocks, out);
}

}  // namespace migiwa
#endif
