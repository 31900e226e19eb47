// The kernels over vectors of Highway: the sum over lanes, values and slopes of pairs, and the closed forms
// that gamma is made of. Compiled once for every instruction set: include after <hwy/highway.h>.
#if defined(MIGIWA_KERNELS_SIMD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef MIGIWA_KERNELS_SIMD_INL_H
#undef MIGIWA_KERNELS_SIMD_INL_H
#else
#define MIGIWA_KERNELS_SIMD_INL_H
#endif

#include <hwy/highway.h>

#include "core/sph/kernels.h"

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

// The kernels of kernels.h for several pairs at a time. Compiled once for every instruction set: include
// after <hwy/highway.h>, between HWY_BEFORE_NAMESPACE() and HWY_AFTER_NAMESPACE().

/// Distances of pairs over the support radius, at most 1: q and its square.
template <class V>
struct Distances {
  V q2, q;
};

/// A root and, in the kernels, a division: both are exact to the last digit on every processor. The
/// instructions that approximate them are not.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Distances<V> distances(D d, V squared) {
  const V q2 = hn::Min(squared, hn::Set(d, 1.0F));
  return {q2, hn::Sqrt(q2)};
}

/// shape: W(q) over kValue. push: W'(q) / q over kSlope, which times the offset of a pair is the gradient; of
/// a pair on one point infinite if kSingular. squaredSlope: W'(q)^2 over kSlope^2, given the push. What pairs
/// are summed up for takes the constants once, after the sum.
template <class Kernel>
struct KernelVectors;

template <>
struct KernelVectors<Poly6> {
  static constexpr float kValue = 315 / (64 * kernel_detail::kPi);
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V shape(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q2);
    return hn::Mul(hn::Mul(t, t), t);
  }
};

template <>
struct KernelVectors<Spiky> {
  static constexpr float kValue = 15 / kernel_detail::kPi, kSlope = -45 / kernel_detail::kPi;
  static constexpr bool kSingular = true;
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V shape(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    return hn::Mul(hn::Mul(t, t), t);
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V push(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    return hn::Div(hn::Mul(t, t), r.q);
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V squaredSlope(D d, const Distances<V>& r, V /*push*/) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q), t2 = hn::Mul(t, t);
    return hn::Mul(t2, t2);
  }
};

template <>
struct KernelVectors<CubicSpline> {
  static constexpr float kValue = 8 / kernel_detail::kPi, kSlope = -48 / kernel_detail::kPi;
  static constexpr bool kSingular = false;
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V shape(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    const V inner = hn::NegMulAdd(hn::Mul(hn::Set(d, 6.0F), r.q2), t, hn::Set(d, 1.0F));
    const V outer = hn::Mul(hn::Set(d, 2.0F), hn::Mul(hn::Mul(t, t), t));
    return hn::IfThenElse(hn::Le(r.q, hn::Set(d, 0.5F)), inner, outer);
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V push(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    const V inner = hn::NegMulAdd(hn::Set(d, 3.0F), r.q, hn::Set(d, 2.0F));
    const V outer = hn::Div(hn::Mul(t, t), r.q);
    return hn::IfThenElse(hn::Le(r.q, hn::Set(d, 0.5F)), inner, outer);
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V squaredSlope(D /*d*/, const Distances<V>& r, V push) {
    return hn::Mul(hn::Mul(push, push), r.q2);
  }
};

template <>
struct KernelVectors<WendlandC2> {
  static constexpr float kValue = 21 / (2 * kernel_detail::kPi), kSlope = -210 / kernel_detail::kPi;
  static constexpr bool kSingular = false;
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V shape(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q), t2 = hn::Mul(t, t);
    return hn::Mul(hn::Mul(t2, t2), hn::MulAdd(hn::Set(d, 4.0F), r.q, hn::Set(d, 1.0F)));
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V push(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    return hn::Mul(hn::Mul(t, t), t);
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V squaredSlope(D /*d*/, const Distances<V>& r, V push) {
    return hn::Mul(hn::Mul(push, push), r.q2);
  }
};

// The closed forms of core/sph/kernels.h and core/sph/kernels.h over vectors of Highway, for support
// 1, as polynomials by Horner's rule. Included once for every instruction set, so without #pragma once.

inline constexpr float kPiF = 3.14159265358979F;

template <class D, class V>
HWY_INLINE V horner(D d, V x, float c0, float c1) {
  return hn::MulAdd(hn::Set(d, c1), x, hn::Set(d, c0));
}
/// c0 + c1 x + c2 x^2 + ...
template <class D, class V, class... Rest>
HWY_INLINE V horner(D d, V x, float c0, float c1, Rest... rest) {
  return hn::MulAdd(horner(d, x, c1, rest...), x, hn::Set(d, c0));
}

// Each kernel: taken(e), the part of it beyond a plane at e in [0, 1]; push(e) = -d taken / de. Along a ray,
// mass(r) = G(r) = 4 pi integral_0^r W s^2 ds, and slope(r) = integral_r^1 W' s^2 ds = H(r) - H(1): with the
// first hit g(w) of every direction w,
//   gamma = mean over w of G(g),   h grad gamma = 4 pi * mean over w of (H(g) - H(1)) w.

struct Poly6Lanes {
  template <class D, class V>
  static HWY_INLINE V taken(D d, V e) {
    const V t = hn::Sub(hn::Set(d, 1.0F), e), t2 = hn::Mul(t, t);
    return hn::Mul(hn::Mul(hn::Mul(t2, t2), t),
                   horner(d, e, 0.5F, 325.0F / 256, 345.0F / 256, 175.0F / 256, 35.0F / 256));
  }
  template <class D, class V>
  static HWY_INLINE V push(D d, V e) {
    const V u = hn::NegMulAdd(e, e, hn::Set(d, 1.0F)), u2 = hn::Mul(u, u);
    return hn::Mul(hn::Set(d, 315.0F / 256), hn::Mul(u2, u2));
  }
  template <class D, class V>
  static HWY_INLINE V mass(D d, V r) {
    const V r2 = hn::Mul(r, r);
    return hn::Mul(hn::Mul(r, r2), horner(d, r2, 105.0F / 16, -189.0F / 16, 135.0F / 16, -35.0F / 16));
  }
  template <class D, class V>
  static HWY_INLINE V slope(D d, V r) {
    constexpr float c = 315 / (256 * kPiF);
    const V r2 = hn::Mul(r, r);
    return hn::MulAdd(hn::Mul(r2, r2), horner(d, r2, 6 * c, -8 * c, 3 * c), hn::Set(d, -c));
  }
};

struct SpikyLanes {
  template <class D, class V>
  static HWY_INLINE V taken(D d, V e) {
    const V t = hn::Sub(hn::Set(d, 1.0F), e), t2 = hn::Mul(t, t);
    return hn::Mul(hn::Mul(hn::Mul(t2, t2), t), hn::Add(hn::Set(d, 0.5F), e));
  }
  template <class D, class V>
  static HWY_INLINE V push(D d, V e) {
    const V t = hn::Sub(hn::Set(d, 1.0F), e), t2 = hn::Mul(t, t);
    return hn::Mul(hn::Mul(t2, t2), horner(d, e, 1.5F, 6.0F));
  }
  template <class D, class V>
  static HWY_INLINE V mass(D d, V r) {
    return hn::Mul(hn::Mul(hn::Mul(r, r), r), horner(d, r, 20.0F, -45.0F, 36.0F, -10.0F));
  }
  template <class D, class V>
  static HWY_INLINE V slope(D d, V r) {
    constexpr float c = 1.5F / kPiF;
    return hn::MulAdd(hn::Mul(hn::Mul(r, r), r), horner(d, r, 10 * c, -15 * c, 6 * c), hn::Set(d, -c));
  }
};

struct CubicSplineLanes {
  template <class D, class V>
  static HWY_INLINE V taken(D d, V e) {
    const V t = hn::Sub(hn::Set(d, 1.0F), e), t2 = hn::Mul(t, t);
    const V inner = horner(d, e, 0.5F, -1.4F, 0.0F, 8.0F / 3, 0.0F, -24.0F / 5, 16.0F / 5);
    const V outer = hn::Mul(hn::Mul(hn::Mul(t2, t2), t), horner(d, e, 8.0F / 15, 16.0F / 15));
    return hn::IfThenElse(hn::Gt(e, hn::Set(d, 0.5F)), outer, inner);
  }
  template <class D, class V>
  static HWY_INLINE V push(D d, V e) {
    const V t = hn::Sub(hn::Set(d, 1.0F), e), t2 = hn::Mul(t, t);
    const V inner = horner(d, e, 1.4F, 0.0F, -8.0F, 0.0F, 24.0F, -96.0F / 5);
    const V outer = hn::Mul(hn::Mul(t2, t2), horner(d, e, 1.6F, 6.4F));
    return hn::IfThenElse(hn::Gt(e, hn::Set(d, 0.5F)), outer, inner);
  }
  template <class D, class V>
  static HWY_INLINE V mass(D d, V r) {
    const V r3 = hn::Mul(hn::Mul(r, r), r);
    const V inner = hn::Mul(r3, horner(d, r, 32.0F / 3, 0.0F, -38.4F, 32.0F));
    const V outer =
        hn::MulAdd(r3, horner(d, r, 64.0F / 3, -48.0F, 38.4F, -32.0F / 3), hn::Set(d, -1.0F / 15));
    return hn::IfThenElse(hn::Gt(r, hn::Set(d, 0.5F)), outer, inner);
  }
  template <class D, class V>
  static HWY_INLINE V slope(D d, V r) {
    constexpr float c = 1 / kPiF;
    const V r3 = hn::Mul(hn::Mul(r, r), r);
    const V inner = hn::MulAdd(hn::Mul(r3, r), horner(d, r, 24 * c, -28.8F * c), hn::Set(d, -1.4F * c));
    const V outer = hn::MulAdd(r3, horner(d, r, 16 * c, -24 * c, 9.6F * c), hn::Set(d, -1.6F * c));
    return hn::IfThenElse(hn::Gt(r, hn::Set(d, 0.5F)), outer, inner);
  }
};

struct WendlandC2Lanes {
  template <class D, class V>
  static HWY_INLINE V taken(D d, V e) {
    const V t = hn::Sub(hn::Set(d, 1.0F), e), t2 = hn::Mul(t, t);
    return hn::Mul(hn::Mul(hn::Mul(t2, t2), t2), horner(d, e, 0.5F, 1.5F, 1.5F));
  }
  template <class D, class V>
  static HWY_INLINE V push(D d, V e) {
    const V t = hn::Sub(hn::Set(d, 1.0F), e), t2 = hn::Mul(t, t);
    return hn::Mul(hn::Mul(hn::Mul(t2, t2), t), horner(d, e, 1.5F, 7.5F, 12.0F));
  }
  template <class D, class V>
  static HWY_INLINE V mass(D d, V r) {
    return hn::Mul(hn::Mul(hn::Mul(r, r), r), horner(d, r, 14.0F, 0.0F, -84.0F, 140.0F, -90.0F, 21.0F));
  }
  template <class D, class V>
  static HWY_INLINE V slope(D d, V r) {
    constexpr float c = 1.5F / kPiF;
    const V r2 = hn::Mul(r, r);
    return hn::MulAdd(hn::Mul(r2, r2), horner(d, r, 35 * c, -84 * c, 70 * c, -20 * c), hn::Set(d, -c));
  }
};

/// The kernel of the pair gradients, as PairKernel of core/sph/kernels.h.
template <class Kernel>
struct PairLanesOf {
  using Type = Kernel;
  static constexpr bool kSame = true;
};
template <>
struct PairLanesOf<Poly6Lanes> {
  using Type = SpikyLanes;
  static constexpr bool kSame = false;
};

/// Body::run<Kernel>(arguments...) for the kernel that the type names.
template <class Body, class... Arguments>
void withKernelLanes(KernelType type, Arguments&&... arguments) {
  switch (type) {
    case KernelType::poly6:
      return Body::template run<Poly6Lanes>(arguments...);
    case KernelType::spiky:
      return Body::template run<SpikyLanes>(arguments...);
    case KernelType::cubicSpline:
      return Body::template run<CubicSplineLanes>(arguments...);
    case KernelType::wendlandC2:
      return Body::template run<WendlandC2Lanes>(arguments...);
  }
}

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // MIGIWA_KERNELS_SIMD_INL_H
