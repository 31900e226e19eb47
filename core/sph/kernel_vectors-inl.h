// The kernels of kernels.h for several pairs at a time. Compiled once for every instruction set: include
// after <hwy/highway.h>, between HWY_BEFORE_NAMESPACE() and HWY_AFTER_NAMESPACE().
#if defined(MIGIWA_KERNEL_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef MIGIWA_KERNEL_VECTORS_INL_H
#undef MIGIWA_KERNEL_VECTORS_INL_H
#else
#define MIGIWA_KERNEL_VECTORS_INL_H
#endif

#include <hwy/highway.h>

#include "core/sph/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace migiwa::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Distances of pairs over the support radius, at most 1: q, its square and its inverse.
template <class V>
struct Distances {
  V q2, q, inverse;
};

/// 1 / sqrt(v), within two units of the last digit.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V inverseSqrt(D d, V v) {
#if HWY_TARGET == HWY_EMU128 || HWY_TARGET == HWY_SCALAR
  return hn::Div(hn::Set(d, 1.0F), hn::Sqrt(v));
#else
  const V guess = hn::ApproximateReciprocalSqrt(v);
  const V half = hn::Mul(hn::Mul(v, guess), hn::Set(d, 0.5F));
  return hn::Mul(guess, hn::NegMulAdd(half, guess, hn::Set(d, 1.5F)));
#endif
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Distances<V> distances(D d, V squared) {
  const V q2 = hn::Min(squared, hn::Set(d, 1.0F));
  const V inverse = inverseSqrt(d, q2);
  return {q2, hn::Mul(q2, inverse), inverse};
}

/// value: W(q). slopeOverDistance: W'(q) / q, which times the offset of a pair is the gradient.
template <class Kernel>
struct KernelVectors;

template <>
struct KernelVectors<Poly6> {
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V value(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q2);
    return hn::Mul(hn::Set(d, 315 / (64 * kernel_detail::kPi)), hn::Mul(hn::Mul(t, t), t));
  }
};

template <>
struct KernelVectors<Spiky> {
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V value(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    return hn::Mul(hn::Set(d, 15 / kernel_detail::kPi), hn::Mul(hn::Mul(t, t), t));
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V slopeOverDistance(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    return hn::Mul(hn::Mul(hn::Set(d, -45 / kernel_detail::kPi), r.inverse), hn::Mul(t, t));
  }
};

template <>
struct KernelVectors<CubicSpline> {
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V value(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    const V inner = hn::NegMulAdd(hn::Mul(hn::Set(d, 6.0F), r.q2), t, hn::Set(d, 1.0F));
    const V outer = hn::Mul(hn::Set(d, 2.0F), hn::Mul(hn::Mul(t, t), t));
    return hn::Mul(hn::Set(d, 8 / kernel_detail::kPi),
                   hn::IfThenElse(hn::Le(r.q, hn::Set(d, 0.5F)), inner, outer));
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V slopeOverDistance(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    const V inner = hn::NegMulAdd(hn::Set(d, 3.0F), r.q, hn::Set(d, 2.0F));
    const V outer = hn::Mul(hn::Mul(t, t), r.inverse);
    return hn::Mul(hn::Set(d, -48 / kernel_detail::kPi),
                   hn::IfThenElse(hn::Le(r.q, hn::Set(d, 0.5F)), inner, outer));
  }
};

template <>
struct KernelVectors<WendlandC2> {
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V value(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q), t2 = hn::Mul(t, t);
    return hn::Mul(hn::Mul(hn::Set(d, 21 / (2 * kernel_detail::kPi)), hn::Mul(t2, t2)),
                   hn::MulAdd(hn::Set(d, 4.0F), r.q, hn::Set(d, 1.0F)));
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE V slopeOverDistance(D d, const Distances<V>& r) {
    const V t = hn::Sub(hn::Set(d, 1.0F), r.q);
    return hn::Mul(hn::Set(d, -210 / kernel_detail::kPi), hn::Mul(hn::Mul(t, t), t));
  }
};

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // MIGIWA_KERNEL_VECTORS_INL_H
