// The kernels and their closed forms at a plane, held against the formulas of the literature, written down
// here once more in double, and against quadrature.
#include "core/sph/kernels.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include <gtest/gtest.h>

#include "tests/sph/quadrature.h"

namespace migiwa {
namespace kernels_test {

using quadrature::integrate;

constexpr double kPi = std::numbers::pi;

// The first two: Mueller, Charypar, Gross, "Particle-based fluid simulation for interactive applications",
// 2003, with h = 1.
double literature(Poly6, double r) {
  return r > 1 ? 0 : 315 / (64 * kPi) * std::pow(1 - r * r, 3);
}
double literature(Spiky, double r) {
  return r > 1 ? 0 : 15 / kPi * std::pow(1 - r, 3);
}

// Monaghan, "Smoothed particle hydrodynamics", 1992. His h is half the support.
double literature(CubicSpline, double r) {
  const double h = 0.5, q = r / h;
  const double shape = q < 1 ? 1 - 1.5 * q * q + 0.75 * q * q * q : q < 2 ? 0.25 * std::pow(2 - q, 3) : 0;
  return shape / (kPi * h * h * h);
}

// Wendland's C2 function as Dehnen & Aly, "Improving convergence in smoothed particle hydrodynamics
// simulations without pairing instability", 2012, write it in three dimensions: (1 - r)^4_+ (1 + 4r).
double literature(WendlandC2, double r) {
  return r > 1 ? 0 : 21 / (2 * kPi) * std::pow(1 - r, 4) * (1 + 4 * r);
}

/// gamma at signed distance e of a plane by its definition: the kernel's integral over the half ball z > -e,
/// in cylinders around the normal. Panels end where the spline's pieces meet on the axis.
template <class Kernel>
double halfSpaceIntegral(Kernel kernel, double e) {
  const auto slice = [&](double z) {
    const double rim = std::sqrt(std::max(0.0, 1 - z * z));
    return 2 * kPi *
           integrate(0, rim, 12, [&](double s) { return literature(kernel, std::hypot(z, s)) * s; });
  };
  double sum = 0;
  double from = -e;
  for (const double to : {-0.5, 0.0, 0.5, 1.0}) {
    if (to <= from) continue;
    sum += integrate(from, to, 6, slice);
    from = to;
  }
  return sum;
}

template <class Kernel>
class KernelTest : public ::testing::Test {};

using Kernels = ::testing::Types<Poly6, Spiky, CubicSpline, WendlandC2>;
TYPED_TEST_SUITE(KernelTest, Kernels);

// Distances on both sides of every place where a formula changes, and a fine sweep.
std::vector<double> sweep(double from, double to) {
  std::vector<double> points{0, 0.25, 0.5, 0.5 - 1e-7, 0.5 + 1e-7, 1 - 1e-7, 1e-7};
  for (int i = 0; i <= 200; ++i) points.push_back(from + (to - from) * i / 200);
  return points;
}

TYPED_TEST(KernelTest, ValueIsTheLiteratures) {
  const double peak = literature(TypeParam{}, 0);
  for (const double q : sweep(0, 1.2)) {
    // The test's formula is taken where the float is, not where the double was.
    const auto single = static_cast<float>(q);
    EXPECT_NEAR(TypeParam::value(single), literature(TypeParam{}, single), 1e-6 * peak) << "q = " << q;
  }
}

TYPED_TEST(KernelTest, IntegratesToOneOverItsBall) {
  const auto shell = [](double q) {
    return 4 * kPi * static_cast<double>(TypeParam::value(static_cast<float>(q))) * q * q;
  };
  EXPECT_NEAR(integrate(0, 0.5, 64, shell) + integrate(0.5, 1, 64, shell), 1, 1e-6);
}

TYPED_TEST(KernelTest, DerivativeMatchesCentralDifferences) {
  const double step = 1e-5;
  const double scale = literature(TypeParam{}, 0);
  for (const double q : sweep(0.01, 0.99)) {
    if (q < step || q + step > 1) continue;
    const auto single = static_cast<double>(static_cast<float>(q));
    const double expected =
        (literature(TypeParam{}, single + step) - literature(TypeParam{}, single - step)) / (2 * step);
    EXPECT_NEAR(TypeParam::derivative(static_cast<float>(q)), expected, 1e-5 * scale) << "q = " << q;
  }
}

TYPED_TEST(KernelTest, VanishesBeyondItsSupport) {
  for (const float q : {1.0F, 1.0001F, 2.0F, 1e10F, std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(TypeParam::value(q), 0) << q;
    EXPECT_EQ(TypeParam::derivative(q), 0) << q;
  }
}

TYPED_TEST(KernelTest, FallsOutwardsAndIsNeverNegative) {
  float last = TypeParam::value(0);
  for (int i = 1; i <= 1000; ++i) {
    const float q = static_cast<float>(i) / 1000;
    EXPECT_LE(TypeParam::value(q), last) << q;
    EXPECT_GE(TypeParam::value(q), 0) << q;
    EXPECT_LE(TypeParam::derivative(q), 0) << q;
    last = TypeParam::value(q);
  }
}

TYPED_TEST(KernelTest, TheQuadratureItselfGivesOneForTheWholeBallAndAHalfForHalf) {
  EXPECT_NEAR(halfSpaceIntegral(TypeParam{}, 1), 1, 1e-8);
  EXPECT_NEAR(halfSpaceIntegral(TypeParam{}, 0), 0.5, 1e-8);
}

TYPED_TEST(KernelTest, PlaneGammaIsTheIntegralOverTheFluidSide) {
  for (const double e : sweep(-1, 1)) {
    const auto single = static_cast<float>(e);
    EXPECT_NEAR(TypeParam::planeGamma(single), halfSpaceIntegral(TypeParam{}, static_cast<double>(single)),
                5e-7)
        << "e = " << e;
  }
}

TYPED_TEST(KernelTest, PlaneGammaSlopeIsTheIntegralOverThePlane) {
  // Moving the plane by de adds a slice: the kernel's integral over the disc at distance e.
  for (const double e : sweep(-1, 1)) {
    const double distance = std::abs(e);
    const double rim = std::sqrt(std::max(0.0, 1 - distance * distance));
    const double expected = 2 * kPi * integrate(0, rim, 48, [&](double s) {
                              return literature(TypeParam{}, std::hypot(distance, s)) * s;
                            });
    EXPECT_NEAR(TypeParam::planeGammaSlope(static_cast<float>(e)), expected, 3e-6) << "e = " << e;
  }
}

TYPED_TEST(KernelTest, PlaneGammaSlopeIsTheDerivativeOfPlaneGamma) {
  // Differences of fourth order, wide enough to stay clear of float's last digits. Spiky's cusp costs them
  // the most.
  const float step = 1.0F / 32;
  const auto gamma = [](float e) { return static_cast<double>(TypeParam::planeGamma(e)); };
  for (int i = -110; i <= 110; ++i) {
    const float e = static_cast<float>(i) / 100;
    const double differences =
        (8 * (gamma(e + step) - gamma(e - step)) - (gamma(e + 2 * step) - gamma(e - 2 * step))) / (12.0 / 32);
    EXPECT_NEAR(TypeParam::planeGammaSlope(e), differences, 4e-4) << "e = " << e;
  }
}

TYPED_TEST(KernelTest, BothSidesOfThePlaneMakeOne) {
  for (const double e : sweep(0, 1.5)) {
    const auto single = static_cast<float>(e);
    EXPECT_EQ(TypeParam::planeGamma(-single), 1 - TypeParam::planeGamma(single)) << "e = " << e;
    EXPECT_EQ(TypeParam::planeGammaSlope(-single), TypeParam::planeGammaSlope(single)) << "e = " << e;
  }
}

TYPED_TEST(KernelTest, PlaneGammaEndsWhereTheSupportEnds) {
  for (const float e : {1.0F, 1.5F, 1e10F, std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(TypeParam::planeGamma(e), 1) << e;
    EXPECT_EQ(TypeParam::planeGamma(-e), 0) << e;
    EXPECT_EQ(TypeParam::planeGammaSlope(e), 0) << e;
    EXPECT_EQ(TypeParam::planeGammaSlope(-e), 0) << e;
  }
  EXPECT_EQ(TypeParam::planeGamma(0), 0.5F);
}

TYPED_TEST(KernelTest, PlaneGammaStaysBetweenZeroAndOne) {
  for (int i = -1200; i <= 1200; ++i) {
    const float gamma = TypeParam::planeGamma(static_cast<float>(i) / 1000);
    EXPECT_GE(gamma, 0) << i;
    EXPECT_LE(gamma, 1) << i;
  }
}

TEST(WithKernel, PicksTheKernelThatTheTypeNames) {
  const auto peak = [](KernelType type) {
    return withKernel(type, [](auto kernel) { return kernel.value(0.25F); });
  };
  EXPECT_EQ(peak(KernelType::poly6), Poly6::value(0.25F));
  EXPECT_EQ(peak(KernelType::spiky), Spiky::value(0.25F));
  EXPECT_EQ(peak(KernelType::cubicSpline), CubicSpline::value(0.25F));
  EXPECT_EQ(peak(KernelType::wendlandC2), WendlandC2::value(0.25F));
}

TEST(WithKernel, SceneNamesStandForTheirKernels) {
  EXPECT_EQ(kKernelNames[static_cast<std::size_t>(KernelType::poly6)], "poly6");
  EXPECT_EQ(kKernelNames[static_cast<std::size_t>(KernelType::spiky)], "spiky");
  EXPECT_EQ(kKernelNames[static_cast<std::size_t>(KernelType::cubicSpline)], "cubic_spline");
  EXPECT_EQ(kKernelNames[static_cast<std::size_t>(KernelType::wendlandC2)], "wendland_c2");
}

TEST(PairKernel, IsSpikyWhereTheDensityKernelIsFlatOrSpiky) {
  EXPECT_TRUE((std::is_same_v<PairKernel<Poly6>, Spiky>));
  EXPECT_TRUE((std::is_same_v<PairKernel<Spiky>, Spiky>));
  EXPECT_TRUE((std::is_same_v<PairKernel<CubicSpline>, CubicSpline>));
  EXPECT_TRUE((std::is_same_v<PairKernel<WendlandC2>, WendlandC2>));
}

}  // namespace kernels_test
}  // namespace migiwa
