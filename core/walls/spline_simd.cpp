#include "core/walls/gridded.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/walls/spline_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

SplineValue splineValueAt(const float* HWY_RESTRICT first, float x, float y, float z) {
  const hn::CappedTag<float, 4> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d), kRow = SplineGrid<1>::kNodes;
  // Weights stay scalars: as vectors they would go through memory, and wait for it.
  const SplineWeights wx(x), wy(y), wz(z);
  alignas(16) float value[4], alongY[4], alongZ[4];
  for (std::size_t part = 0; part < 4; part += kLanes) {
    auto v = hn::Zero(d), dy = hn::Zero(d), dz = hn::Zero(d);
    for (std::size_t k = 0; k < 4; ++k) {
      const float* row = first + k * kRow * kRow + part;
      const auto r0 = hn::LoadU(d, row), r1 = hn::LoadU(d, row + kRow), r2 = hn::LoadU(d, row + 2 * kRow),
                 r3 = hn::LoadU(d, row + 3 * kRow);
      const auto combine = [&](const float* w) {
        return hn::MulAdd(hn::Set(d, w[3]), r3,
                          hn::MulAdd(hn::Set(d, w[2]), r2,
                                     hn::MulAdd(hn::Set(d, w[1]), r1, hn::Mul(hn::Set(d, w[0]), r0))));
      };
      const auto flat = combine(wy.value);
      v = hn::MulAdd(hn::Set(d, wz.value[k]), flat, v);
      dy = hn::MulAdd(hn::Set(d, wz.value[k]), combine(wy.slope), dy);
      dz = hn::MulAdd(hn::Set(d, wz.slope[k]), flat, dz);
    }
    hn::Store(v, d, value + part);
    hn::Store(dy, d, alongY + part);
    hn::Store(dz, d, alongZ + part);
  }
  SplineValue result{0, Vec3f::Zero()};
  for (std::size_t k = 0; k < 4; ++k) {
    result.value += wx.value[k] * value[k];
    result.gradient += Vec3f(wx.slope[k] * value[k], wx.value[k] * alongY[k], wx.value[k] * alongZ[k]);
  }
  return result;
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(splineValueAt);

SplineValue splineValue(const float* first, float x, float y, float z) {
  return HWY_DYNAMIC_DISPATCH(splineValueAt)(first, x, y, z);
}

}  // namespace migiwa
#endif  // HWY_ONCE
