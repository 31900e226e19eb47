#include <algorithm>
#include <cmath>

#include "core/gamma/baked.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/gamma/grid_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kRow = 2 * GammaGrid::kNodes, kLayer = kRow * GammaGrid::kNodes;
/// So many points ahead coefficients are fetched: most are in no near cache.
constexpr std::size_t kAhead = 4;

HWY_INLINE void prefetch(const float* from) {
  constexpr int kLineFloats = 16;
  for (int layer = 0; layer < 4; ++layer)
    for (int at = 0; at < 3 * kRow + 8; at += kLineFloats) __builtin_prefetch(from + layer * kLayer + at);
}

HWY_INLINE void interpolateAt(const float* HWY_RESTRICT from, const Vec3f& within, float toGradient,
                              GammaSample& sample) {
  using D = hn::CappedTag<float, 8>;
  const D d;
  constexpr std::size_t kParts = 8 / hn::MaxLanes(d);
  const SplineWeights wx(within.x()), wy(within.y()), wz(within.z());
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

void interpolateBatch(const GammaGrid& grid, float supportRadius, std::span<const GammaGrid::Place> places,
                      std::span<GammaSample> out) {
  const float toGradient = supportRadius / grid.cell;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (const std::size_t next = i + kAhead; next < places.size() && places[next].state >= 0)
      prefetch(grid.about(places[next]));
    if (places[i].state >= 0) interpolateAt(grid.about(places[i]), places[i].within, toGradient, out[i]);
  }
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(interpolateBatch);

void interpolate(const GammaGrid& grid, float supportRadius, std::span<const GammaGrid::Place> places,
                 std::span<GammaSample> out) {
  HWY_DYNAMIC_DISPATCH(interpolateBatch)(grid, supportRadius, places, out);
}

}  // namespace migiwa
#endif
