#include <algorithm>
#include <array>
#include <cstring>

#include "core/gamma/batches.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/gamma/planar_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/sph/kernels_simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

/// Eight points at a time at most: batches are short.
using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;

/// A vector quantity at all points.
struct V3 {
  V x, y, z;
};

HWY_INLINE V3 plus(const V3& a, const V3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE V3 times(const V3& a, V s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
HWY_INLINE V3 along(const FlatPlane& plane, V s) {
  const D d;
  return {hn::Mul(hn::Set(d, plane.unit.x()), s), hn::Mul(hn::Set(d, plane.unit.y()), s),
          hn::Mul(hn::Set(d, plane.unit.z()), s)};
}

/// A product of the axes' parts, and its gradient.
struct Product {
  V value;
  V3 gradient;

  HWY_INLINE void multiply(V part, const V3& slope) {
    gradient = plus(times(gradient, part), times(slope, value));
    value = hn::Mul(value, part);
  }
};

/// What the planes of one axis take of a kernel, and its slope. Two planes that face each other take at most
/// all of it, and then none of it changes with the place.
template <class Kernel>
HWY_INLINE void multiplyAxis(Product& product, const FlatPlane& first, V e, const FlatPlane* second, V f) {
  const D d;
  const V one = hn::Set(d, 1.0F), zero = hn::Zero(d);
  const auto taken = [&](V at) HWY_ATTR {
    const V deep = Kernel::taken(d, hn::Min(hn::Abs(at), one));
    return hn::IfThenElse(hn::Lt(at, zero), hn::Sub(one, deep), deep);
  };
  V part = hn::Sub(one, taken(e));
  V3 slope = along(first, Kernel::push(d, hn::Min(hn::Abs(e), one)));
  if (second != nullptr) {
    part = hn::Sub(part, taken(f));
    slope = plus(slope, along(*second, Kernel::push(d, hn::Min(hn::Abs(f), one))));
    const auto some = hn::Gt(part, zero);
    part = hn::IfThenElseZero(some, part);
    slope = {hn::IfThenElseZero(some, slope.x), hn::IfThenElseZero(some, slope.y),
             hn::IfThenElseZero(some, slope.z)};
  }
  product.multiply(part, slope);
}

HWY_INLINE V distanceTo(const FlatPlane& plane, const V3& p) {
  const D d;
  return hn::MulAdd(hn::Set(d, plane.normal.x()), p.x,
                    hn::MulAdd(hn::Set(d, plane.normal.y()), p.y,
                               hn::MulAdd(hn::Set(d, plane.normal.z()), p.z, hn::Set(d, plane.offset))));
}

/// As many points as a vector holds.
template <class Kernel>
HWY_INLINE void productAt(const FlatPlanes& walls, float supportRadius, const Float4* points,
                          GammaSample* out) {
  using Pair = typename PairLanesOf<Kernel>::Type;
  const D d;
  const V one = hn::Set(d, 1.0F), zero = hn::Zero(d);
  V3 p;
  V ignored;
  hn::LoadInterleaved4(d, &points->x, p.x, p.y, p.z, ignored);
  V nearest = hn::Set(d, 1e30F);
  Product product{one, {zero, zero, zero}}, pair = product;
  const auto planes = walls.planes();
  for (const FlatPlanes::Axis& axis : walls.axes()) {
    const FlatPlane& first = planes[static_cast<std::size_t>(axis.first)];
    const FlatPlane* second = axis.second < 0 ? nullptr : &planes[static_cast<std::size_t>(axis.second)];
    const V e = distanceTo(first, p);
    const V f = second != nullptr ? distanceTo(*second, p) : e;
    const V nearer = hn::Min(e, f);
    nearest = hn::Min(nearest, nearer);
    if (hn::AllTrue(d, hn::Ge(nearer, one))) continue;
    // Where only one of the two is in reach of any point, the other takes nothing.
    if (second != nullptr && hn::AllTrue(d, hn::Ge(f, one))) second = nullptr;
    multiplyAxis<Kernel>(product, first, e, second, f);
    if (!PairLanesOf<Kernel>::kSame) multiplyAxis<Pair>(pair, first, e, second, f);
  }
  if (PairLanesOf<Kernel>::kSame) pair = product;
  // The sample's fields in their order, four at a time.
  alignas(32) float lower[4 * hn::MaxLanes(d)], upper[4 * hn::MaxLanes(d)];
  hn::StoreInterleaved4(product.value, hn::Mul(nearest, hn::Set(d, supportRadius)), product.gradient.x,
                        product.gradient.y, d, lower);
  hn::StoreInterleaved4(product.gradient.z, pair.gradient.x, pair.gradient.y, pair.gradient.z, d, upper);
  auto* to = reinterpret_cast<float*>(out);
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    std::memcpy(to + 8 * k, lower + 4 * k, 4 * sizeof(float));
    std::memcpy(to + 8 * k + 4, upper + 4 * k, 4 * sizeof(float));
  }
}

struct ProductBatch {
  template <class Kernel>
  static void run(const FlatPlanes& walls, float supportRadius, std::span<const Float4> points,
                  std::span<GammaSample> out) {
    const std::size_t lanes = hn::Lanes(D());
    std::size_t i = 0;
    for (; i + lanes <= points.size(); i += lanes)
      productAt<Kernel>(walls, supportRadius, &points[i], &out[i]);
    if (i == points.size()) return;
    std::array<Float4, hn::MaxLanes(D())> rest;
    std::array<GammaSample, hn::MaxLanes(D())> samples;
    rest.fill(points[i]);
    std::copy(points.begin() + static_cast<std::ptrdiff_t>(i), points.end(), rest.begin());
    productAt<Kernel>(walls, supportRadius, rest.data(), samples.data());
    std::copy_n(samples.begin(), points.size() - i, out.begin() + static_cast<std::ptrdiff_t>(i));
  }
};

void productBatch(const FlatPlanes& walls, KernelType kernel, float supportRadius,
                  std::span<const Float4> points, std::span<GammaSample> out) {
  withKernelLanes<ProductBatch>(kernel, walls, supportRadius, points, out);
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace migiwa {

static_assert(sizeof(GammaSample) == 8 * sizeof(float), "productAt writes samples as eight floats");

HWY_EXPORT(productBatch);

void productOfPlanes(const FlatPlanes& walls, KernelType kernel, float supportRadius,
                     std::span<const Float4> points, std::span<GammaSample> out) {
  HWY_DYNAMIC_DISPATCH(productBatch)(walls, kernel, supportRadius, points, out);
}

}  // namespace migiwa
#endif
