// Integrals of the kernels along a ray from the centre, for support 1. With the first hit g(w) of every
// direction w,
//   gamma = mean over w of G(g),   h grad gamma = 4 pi * mean over w of (H(g) - H(1)) w,
// where G(r) = 4 pi integral_0^r W s^2 ds and H(r) = -integral_0^r W'(s) s^2 ds. G(1) = 1. Arguments in [0,
// 1], floats or vectors of them.
#pragma once

#include <numbers>

#include "core/sph/kernels.h"

namespace migiwa {

template <class Kernel>
struct RadialIntegrals;

template <>
struct RadialIntegrals<Poly6> {
  template <class V>
  static constexpr V mass(V r) {
    const V r2 = r * r;
    return r * r2 * (105 + r2 * (-189 + r2 * (135 - 35 * r2))) * 0.0625F;
  }
  template <class V>
  static constexpr V slope(V r) {
    const V r2 = r * r;
    return 315 / (256 * kernel_detail::kPi) * r2 * r2 * (6 + r2 * (-8 + 3 * r2));
  }
};

template <>
struct RadialIntegrals<Spiky> {
  template <class V>
  static constexpr V mass(V r) {
    return r * r * r * (20 + r * (-45 + r * (36 - 10 * r)));
  }
  template <class V>
  static constexpr V slope(V r) {
    return 1.5F / kernel_detail::kPi * r * r * r * (10 + r * (-15 + 6 * r));
  }
};

template <>
struct RadialIntegrals<CubicSpline> {
  template <class V>
  static constexpr V mass(V r) {
    const V inner = 32 * r * r * r * (1.0F / 3 + r * r * (-1.2F + r));
    const V outer = 64 * r * r * r * (1.0F / 3 + r * (-0.75F + r * (0.6F - r * (1.0F / 6)))) - 1.0F / 15;
    return r <= 0.5F ? inner : outer;
  }
  template <class V>
  static constexpr V slope(V r) {
    const V inner = 8 * r * r * r * r * (3 - 3.6F * r);
    const V outer = 48 * r * r * r * (1.0F / 3 + r * (-0.5F + 0.2F * r)) - 0.2F;
    return (r <= 0.5F ? inner : outer) * (1 / kernel_detail::kPi);
  }
};

template <>
struct RadialIntegrals<WendlandC2> {
  template <class V>
  static constexpr V mass(V r) {
    const V r2 = r * r;
    return r * r2 * (14 + r2 * (-84 + r * (140 + r * (-90 + 21 * r))));
  }
  template <class V>
  static constexpr V slope(V r) {
    const V r2 = r * r;
    return 210 / kernel_detail::kPi * r2 * r2 * (0.25F + r * (-0.6F + r * (0.5F - r * (1.0F / 7))));
  }
};

}  // namespace migiwa
