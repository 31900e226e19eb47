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

}  // namespace migiwa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // MIGIWA_KERNEL_VECTORS_INL_H
