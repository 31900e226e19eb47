// The smoothing kernels: values, slopes, integrals, and the lattice of fluid at rest.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

namespace migiwa {

// The smoothing kernels a scene can name.

enum class KernelType { poly6, spiky, cubicSpline, wendlandC2 };
inline constexpr std::array<std::string_view, 4> kKernelNames{"poly6", "spiky", "cubic_spline",
                                                              "wendland_c2"};

// The smoothing kernels W(q), q = r/h, for support 1, with the closed forms of gamma for one plane ([FM] Eqs.
// 6 to 8). Multiply W by 1/h^3 and its derivative by 1/h^4 for SI units. planeGamma(e) is the part of the
// kernel on the fluid side of a plane at signed distance e = d/h; planeGammaSlope(e) its derivative, so grad
// gamma = slope * n / h. The forms in T = 1 - e do not cancel in float.

namespace kernel_detail {

inline constexpr float kPi = std::numbers::pi_v<float>;

inline constexpr float square(float v) {
  return v * v;
}
inline constexpr float cube(float v) {
  return v * v * v;
}
inline constexpr float fifth(float v) {
  return square(square(v)) * v;
}

/// Extends a gamma known for e in [0, 1) by gamma(-e) = 1 - gamma(e).
template <class Positive>
constexpr float extendGamma(float e, Positive positive) {
  if (e >= 1) return 1;
  if (e <= -1) return 0;
  return e >= 0 ? positive(e) : 1 - positive(-e);
}

/// Extends a slope known for e in [0, 1) by symmetry.
template <class Positive>
constexpr float extendSlope(float e, Positive positive) {
  const float distance = e < 0 ? -e : e;
  return distance < 1 ? positive(distance) : 0;
}

}  // namespace kernel_detail

/// Mueller, Charypar, Gross 2003; flat at the centre, so it serves densities only.
struct Poly6 {
  static constexpr float value(float q) {
    return q < 1 ? 315 / (64 * kernel_detail::kPi) * kernel_detail::cube(1 - q * q) : 0;
  }
  static constexpr float derivative(float q) {
    return q < 1 ? -6 * q * 315 / (64 * kernel_detail::kPi) * kernel_detail::square(1 - q * q) : 0;
  }
  static constexpr float planeGamma(float e) {
    return kernel_detail::extendGamma(e, [](float d) {
      return 1 - kernel_detail::fifth(1 - d) * (128 + d * (325 + d * (345 + d * (175 + d * 35)))) / 256;
    });
  }
  static constexpr float planeGammaSlope(float e) {
    return kernel_detail::extendSlope(
        e, [](float d) { return 315.0F / 256 * kernel_detail::square(kernel_detail::square(1 - d * d)); });
  }
};

/// Mueller, Charypar, Gross 2003 after Desbrun; its gradient pushes apart particles that are close.
struct Spiky {
  static constexpr float value(float q) {
    return q < 1 ? 15 / kernel_detail::kPi * kernel_detail::cube(1 - q) : 0;
  }
  static constexpr float derivative(float q) {
    return q < 1 ? -45 / kernel_detail::kPi * kernel_detail::square(1 - q) : 0;
  }
  static constexpr float planeGamma(float e) {
    return kernel_detail::extendGamma(e,
                                      [](float d) { return 1 - kernel_detail::fifth(1 - d) * (0.5F + d); });
  }
  static constexpr float planeGammaSlope(float e) {
    return kernel_detail::extendSlope(
        e, [](float d) { return kernel_detail::square(kernel_detail::square(1 - d)) * (1.5F + 6 * d); });
  }
};

/// Monaghan 1992.
struct CubicSpline {
  static constexpr float value(float q) {
    if (q >= 1) return 0;
    return q <= 0.5F ? 8 / kernel_detail::kPi * (1 - 6 * q * q * (1 - q))
                     : 16 / kernel_detail::kPi * kernel_detail::cube(1 - q);
  }
  static constexpr float derivative(float q) {
    if (q >= 1) return 0;
    return q <= 0.5F ? -48 / kernel_detail::kPi * q * (2 - 3 * q)
                     : -48 / kernel_detail::kPi * kernel_detail::square(1 - q);
  }
  static constexpr float planeGamma(float e) {
    return kernel_detail::extendGamma(e, [](float d) {
      if (d > 0.5F) return 1 - 8.0F / 15 * kernel_detail::fifth(1 - d) * (1 + 2 * d);
      const float d2 = d * d;
      return 0.5F + d * (1.4F + d2 * (-8.0F / 3 + d2 * (24.0F / 5 - d * 16.0F / 5)));
    });
  }
  static constexpr float planeGammaSlope(float e) {
    return kernel_detail::extendSlope(e, [](float d) {
      if (d > 0.5F) return 1.6F * kernel_detail::square(kernel_detail::square(1 - d)) * (1 + 4 * d);
      const float d2 = d * d;
      return 1.4F + d2 * (-8 + d2 * (24 - d * 96.0F / 5));
    });
  }
};

/// Wendland 1995, C2.
struct WendlandC2 {
  static constexpr float value(float q) {
    return q < 1 ? 21 / (2 * kernel_detail::kPi) * kernel_detail::square(kernel_detail::square(1 - q)) *
                       (1 + 4 * q)
                 : 0;
  }
  static constexpr float derivative(float q) {
    return q < 1 ? -210 / kernel_detail::kPi * q * kernel_detail::cube(1 - q) : 0;
  }
  static constexpr float planeGamma(float e) {
    return kernel_detail::extendGamma(
        e, [](float d) { return 1 - 0.5F * kernel_detail::fifth(1 - d) * (1 - d) * (1 + 3 * d * (1 + d)); });
  }
  static constexpr float planeGammaSlope(float e) {
    return kernel_detail::extendSlope(
        e, [](float d) { return 1.5F * kernel_detail::fifth(1 - d) * (1 + d * (5 + 8 * d)); });
  }
};

/// The kernel whose gradient moves particles, for a given density kernel: Spiky's where the density kernel's
/// own gradient vanishes at the centre (Macklin & Mueller 2013), else the kernel's own.
template <class Kernel>
struct PairKernelOf {
  using Type = Kernel;
};
template <>
struct PairKernelOf<Poly6> {
  using Type = Spiky;
};
template <class Kernel>
using PairKernel = typename PairKernelOf<Kernel>::Type;

/// Calls body(Kernel{}) with the kernel that the type names, so that inner loops are compiled for each.
template <class Body>
decltype(auto) withKernel(KernelType type, const Body& body) {
  switch (type) {
    case KernelType::spiky:
      return body(Spiky{});
    case KernelType::cubicSpline:
      return body(CubicSpline{});
    case KernelType::wendlandC2:
      return body(WendlandC2{});
    case KernelType::poly6:
      break;
  }
  return body(Poly6{});
}

// The mass of a kernel of support 1 within a radius, G(r) = 4 pi integral_0^r W s^2 ds for r in [0, 1]; G(1)
// =
// 1. [FM] Eq. 7. Its twin over vectors, with the slope, is in core/sph/kernels_simd-inl.h.

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

// What the kernels sum to on the cubic lattice that a scene starts from. The rest density is that sum, so
// that a resting lattice has C = 0, and Eq. 11's epsilon is measured in units of its constraint gradients.

struct RestingLattice {
  /// m / (rho0 h^3): what one particle adds to rho/rho0 is this times W(q).
  float massRatio;
  /// Sum over the neighbours of |h grad_k C|^2 at rest (1).
  float squaredGradients;
  /// Of besideWalls(), per 1 - gamma and per its square.
  float wallSlope, wallBend;

  /// What the sum over the neighbours reads beside walls where fluid is at rest, over gamma times that far
  /// from walls. It is more than 1: gamma is that of a continuum, and the particle itself, whose share is the
  /// largest, is all on the fluid's side. A fit in gamma to a part of what the lattice's first layer has
  /// more, half a spacing from a plane, and where two planes meet and the factor is squared as gamma is.
  float besideWalls(float gamma) const {
    const float covered = 1 - gamma;
    return 1 + covered * (wallSlope + wallBend * covered);
  }
};

/// Sum of term(q) over the places of the lattice within the support radius of one, itself left out; q is the
/// distance over the support radius.
template <class Term>
double latticeSum(double supportRatio, const Term& term) {
  const int reach = static_cast<int>(std::ceil(supportRatio));
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const int square = i * i + j * j + k * k;
        if (square == 0) continue;
        const double q = std::sqrt(static_cast<double>(square)) / supportRatio;
        if (q < 1) sum += term(q);
      }
    }
  }
  return sum;
}

/// `supportRatio`: support radius over spacing, in [1.2, 4].
RestingLattice restingLattice(KernelType kernel, double supportRatio);

}  // namespace migiwa
