// The lattice sums that the rest density and Eq. 11's epsilon come from.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/sph/kernels.h"

namespace migiwa {
namespace {

constexpr double kPi = std::numbers::pi;

double poly6(double q) {
  return q < 1 ? 315 / (64 * kPi) * std::pow(1 - q * q, 3) : 0;
}
double spikySlope(double q) {
  return q < 1 ? 45 / kPi * std::pow(1 - q, 2) : 0;
}

// Shells of the cubic lattice: squared distance in spacings, and how many sites it has.
struct Shell {
  int squared;
  int sites;
};
constexpr Shell kShells[] = {{1, 6}, {2, 12}, {3, 8}, {4, 6}, {5, 24}, {6, 24}, {8, 12}, {9, 30}};

TEST(RestingLattice, SumsTheShellsOfTheCubicLattice) {
  for (const double ratio : {1.3, 1.684, 2.0, 2.5, 3.0}) {
    double values = poly6(0), slopes = 0;
    for (const Shell& shell : kShells) {
      const double q = std::sqrt(shell.squared) / ratio;
      values += shell.sites * poly6(q);
      slopes += shell.sites * std::pow(spikySlope(q), 2);
    }
    const RestingLattice lattice = restingLattice(KernelType::poly6, ratio);
    EXPECT_NEAR(static_cast<double>(lattice.massRatio), 1 / values, 1e-6 / values) << ratio;
    const double expected = slopes / (values * values);
    EXPECT_NEAR(static_cast<double>(lattice.squaredGradients), expected, 1e-5 * expected) << ratio;
  }
}

TEST(RestingLattice, ApproachesTheContinuumForWideSupports) {
  // Sum of W(q) over sites of spacing 1/ratio tends to ratio^3 times the kernel's integral, which is one.
  // Spiky's cusp on the site in the middle leaves the largest difference, 1.5%.
  for (const KernelType kernel :
       {KernelType::poly6, KernelType::spiky, KernelType::cubicSpline, KernelType::wendlandC2}) {
    EXPECT_NEAR(static_cast<double>(restingLattice(kernel, 4).massRatio) * 64, 1, 0.02)
        << kKernelNames[static_cast<std::size_t>(kernel)];
  }
}

}  // namespace
}  // namespace migiwa
