// The mass of a kernel of support 1 within a radius, G(r) = 4 pi integral_0^r W s^2 ds for r in [0, 1]; G(1)
// =
// 1. [FM] Eq. 7. Its twin over vectors, with the slope, is in core/boundary/gamma/kernel_lanes.inl.
#pragma once

#include "core/sph/kernels.h"

namespace migiwa {

template <class Kernel>
struct RadialIntegrals;

template <>
struct RadialIntegrals<Poly6> {
  static constexpr float mass(float r) {
    const float r2 = r * r;
    return r * r2 * (105 + r2 * (-189 + r2 * (135 - 35 * r2))) * 0.0625F;
  }
};

template <>
struct RadialIntegrals<Spiky> {
  static constexpr float mass(float r) { return r * r * r * (20 + r * (-45 + r * (36 - 10 * r))); }
};

template <>
struct RadialIntegrals<CubicSpline> {
  static constexpr float mass(float r) {
    const float inner = 32 * r * r * r * (1.0F / 3 + r * r * (-1.2F + r));
    const float outer = 64 * r * r * r * (1.0F / 3 + r * (-0.75F + r * (0.6F - r * (1.0F / 6)))) - 1.0F / 15;
    return r <= 0.5F ? inner : outer;
  }
};

template <>
struct RadialIntegrals<WendlandC2> {
  static constexpr float mass(float r) {
    const float r2 = r * r;
    return r * r2 * (14 + r2 * (-84 + r * (140 + r * (-90 + 21 * r))));
  }
};

}  // namespace migiwa
