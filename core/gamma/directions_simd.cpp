#include <algorithm>
#include <numeric>
#include <vector>

#include "core/gamma/batches.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/gamma/directions_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/sph/kernels_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;

struct Sums {
  V mass, x, y, z, pairX, pairY, pairZ;

  HWY_INLINE Sums() { mass = x = y = z = pairX = pairY = pairZ = hn::Zero(D()); }

  HWY_INLINE void add(V held, V slope, V pairSlope, V wx, V wy, V wz) {
    mass = hn::Add(mass, held);
    x = hn::MulAdd(slope, wx, x), y = hn::MulAdd(slope, wy, y), z = hn::MulAdd(slope, wz, z);
    pairX = hn::MulAdd(pairSlope, wx, pairX), pairY = hn::MulAdd(pairSlope, wy, pairY),
    pairZ = hn::MulAdd(pairSlope, wz, pairZ);
  }

  RaySums total() const {
    return {sumLanes(mass),
            {sumLanes(x), sumLanes(y), sumLanes(z)},
            {sumLanes(pairX), sumLanes(pairY), sumLanes(pairZ)}};
  }
};

struct Rays {
  template <class Kernel>
  static void run(const Directions& directions, std::span<const float> hits, float supportRadius, float sign,
                  RaySums& total) {
    using Pair = typename PairLanesOf<Kernel>::Type;
    const D d;
    const V inverse = hn::Set(d, 1 / supportRadius), one = hn::Set(d, 1.0F);
    Sums sums;
    for (std::size_t k = 0; k < hits.size(); k += hn::Lanes(d)) {
      const V r = hn::Min(hn::Mul(hn::LoadU(d, &hits[k]), inverse), one);
      sums.add(Kernel::mass(d, r), Kernel::slope(d, r), Pair::slope(d, r), hn::LoadU(d, &directions.x[k]),
               hn::LoadU(d, &directions.y[k]), hn::LoadU(d, &directions.z[k]));
    }
    const RaySums added = sums.total();
    total.mass += sign * added.mass;
    total.slope += sign * added.slope;
    total.pairSlope += sign * added.pairSlope;
  }
};

struct Beyond {
  template <class Kernel>
  static void run(const Directions& directions, std::span<const HalfSpace> planes, RaySums& total) {
    using Pair = typename PairLanesOf<Kernel>::Type;
    const D d;
    const V one = hn::Set(d, 1.0F);
    // 1/r of the hit with a plane is w . scaled.
    const std::size_t count = planes.size();
    Vec3f scaled[kMostRayPlanes];
    for (std::size_t k = 0; k < count; ++k) scaled[k] = planes[k].normal / -std::max(planes[k].e, 1e-9F);
    Sums sums;
    for (std::size_t k = 0; k < directions.size(); k += hn::Lanes(d)) {
      const V x = hn::LoadU(d, &directions.x[k]), y = hn::LoadU(d, &directions.y[k]),
              z = hn::LoadU(d, &directions.z[k]);
      const auto inverseHit = [&](const Vec3f& plane) HWY_ATTR {
        return hn::MulAdd(hn::Set(d, plane.x()), x,
                          hn::MulAdd(hn::Set(d, plane.y()), y, hn::Mul(hn::Set(d, plane.z()), z)));
      };
      const V alone = hn::Max(inverseHit(scaled[0]), one);
      V all = alone;
      for (std::size_t plane = 1; plane < count; ++plane) all = hn::Max(all, inverseHit(scaled[plane]));
      if (hn::AllTrue(d, hn::Eq(all, alone))) continue;
      const V r = hn::Div(one, all), r0 = hn::Div(one, alone);
      sums.add(hn::Sub(Kernel::mass(d, r), Kernel::mass(d, r0)),
               hn::Sub(Kernel::slope(d, r), Kernel::slope(d, r0)),
               hn::Sub(Pair::slope(d, r), Pair::slope(d, r0)), x, y, z);
    }
    total = sums.total();
  }
};

void raysBatch(KernelType kernel, const Directions& directions, std::span<const float> hits,
               float supportRadius, float sign, RaySums& sums) {
  withKernelLanes<Rays>(kernel, directions, hits, supportRadius, sign, sums);
}

void beyondBatch(KernelType kernel, const Directions& directions, std::span<const HalfSpace> planes,
                 RaySums& sums) {
  withKernelLanes<Beyond>(kernel, directions, planes, sums);
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

HWY_EXPORT(raysBatch);
HWY_EXPORT(beyondBatch);

namespace {

constexpr std::size_t kGroup = 8;

/// Orders the indices so that halves, quarters, ... down to groups lie together.
void divide(const Directions& set, std::span<std::size_t> order) {
  if (order.size() <= kGroup) return;
  const std::vector<float>* widest = &set.x;
  float width = -1;
  for (const auto* axis : {&set.x, &set.y, &set.z}) {
    const auto [low, high] = std::minmax_element(
        order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return (*axis)[a] < (*axis)[b]; });
    const float extent = (*axis)[*high] - (*axis)[*low];
    if (extent > width) {
      width = extent;
      widest = axis;
    }
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair((*widest)[a], a) < std::pair((*widest)[b], b);
  });
  const std::size_t half = (order.size() / 2 + kGroup - 1) / kGroup * kGroup;
  divide(set, order.first(half));
  divide(set, order.subspan(half));
}

}  // namespace

Directions groupedDirections(int count) {
  constexpr auto group = static_cast<int>(kGroup);
  const Directions set = fibonacciDirections((count + group - 1) / group * group);
  std::vector<std::size_t> order(set.size());
  std::iota(order.begin(), order.end(), 0);
  divide(set, order);
  Directions grouped;
  for (const std::size_t k : order) {
    grouped.x.push_back(set.x[k]);
    grouped.y.push_back(set.y[k]);
    grouped.z.push_back(set.z[k]);
  }
  return grouped;
}

void addRays(KernelType kernel, const Directions& directions, std::span<const float> hits,
             float supportRadius, float sign, RaySums& sums) {
  HWY_DYNAMIC_DISPATCH(raysBatch)(kernel, directions, hits, supportRadius, sign, sums);
}

RaySums beyondFirstPlane(KernelType kernel, const Directions& directions, std::span<const HalfSpace> planes) {
  RaySums sums;
  HWY_DYNAMIC_DISPATCH(beyondBatch)(kernel, directions, planes, sums);
  return sums;
}

}  // namespace migiwa
#endif
