// The sum over the lanes of a vector of eight floats, added in one order: that of Highway's own sum differs
// between its versions. Compiled once for every instruction set: include after <hwy/highway.h>.
#if defined(MIGIWA_SUM_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef MIGIWA_SUM_LANES_INL_H
#undef MIGIWA_SUM_LANES_INL_H
#else
#define MIGIWA_SUM_LANES_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The same on all processors whose vectors hold eight floats; where they are shorter, so is the sum.
HWY_INLINE float sumLanes(hn::Vec<hn::CappedTag<float, 8>> a) {
#if HWY_TARGET == HWY_SCALAR
  return hn::GetLane(a);
#else
#if HWY_MAX_BYTES == 16
  const auto a4 = a;
#else
  const hn::Full128<float> quad;
  const auto a4 = hn::Add(hn::LowerHalf(quad, a), hn::UpperHalf(quad, a));
#endif
  const auto a2 = hn::Add(a4, hn::Shuffle1032(a4));
  return hn::GetLane(hn::Add(a2, hn::Shuffle2301(a2)));
#endif
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // MIGIWA_SUM_LANES_INL_H
