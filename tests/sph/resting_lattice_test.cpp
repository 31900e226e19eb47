// The lattice sums that the rest density and Eq. 11's epsilon come from.
#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "core/sph/kernels.h"

namespace migiwa {
namespace resting_lattice_test {

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

/// Sum of W over the lattice places that are no further than `below` spacings below the middle one, along x
/// and along y.
template <class Kernel>
double latticeBeside(double ratio, int belowX, int belowY) {
  double sum = 0;
  for (int x = -belowX; x <= 4; ++x)
    for (int y = -belowY; y <= 4; ++y)
      for (int z = -4; z <= 4; ++z)
        sum += static_cast<double>(
            Kernel::value(static_cast<float>(std::sqrt(static_cast<double>(x * x + y * y + z * z)) / ratio)));
  return sum;
}

/// The same of a continuum that ends half a spacing beyond them, by the midpoint rule.
template <class Kernel>
double continuumBeside(double ratio, int belowX, int belowY) {
  const auto integral = [](double fromX, double fromY) {
    constexpr int kCells = 48;
    double sum = 0;
    const Vec3d from(fromX, fromY, -1), cell = (Vec3d::Ones() - from) / kCells;
    for (int x = 0; x < kCells; ++x)
      for (int y = 0; y < kCells; ++y)
        for (int z = 0; z < kCells; ++z) {
          const Vec3d at = from + (Vec3d(x, y, z) + Vec3d::Constant(0.5)).cwiseProduct(cell);
          sum += static_cast<double>(Kernel::value(static_cast<float>(at.norm())));
        }
    return sum * cell.prod();
  };
  return integral(std::max(-1.0, -(belowX + 0.5) / ratio), std::max(-1.0, -(belowY + 0.5) / ratio)) /
         integral(-1, -1);
}

// Four fifths of it, beside a plane, in the edge of two, and a layer further in.
TEST(RestingLattice, BesideWallsReadsWhatItsSumsHaveTooMuch) {
  for (const KernelType type : {KernelType::wendlandC2, KernelType::cubicSpline}) {
    for (const double ratio : {2.0, 2.25}) {
      withKernel(type, [&](auto kernel) {
        using Kernel = decltype(kernel);
        const RestingLattice lattice = restingLattice(type, ratio);
        const double everywhere = latticeBeside<Kernel>(ratio, 4, 4);
        for (const auto& [x, y] : {std::pair(0, 4), std::pair(0, 0), std::pair(1, 4), std::pair(0, 1)}) {
          const double gamma = continuumBeside<Kernel>(ratio, x, y);
          const double tooMuch = latticeBeside<Kernel>(ratio, x, y) / everywhere / gamma - 1;
          EXPECT_NEAR(static_cast<double>(lattice.besideWalls(static_cast<float>(gamma))), 1 + 0.8 * tooMuch,
                      0.006)
              << kKernelNames[static_cast<std::size_t>(type)] << ' ' << ratio << ' ' << x << ' ' << y;
        }
        EXPECT_EQ(lattice.besideWalls(1), 1);
      });
    }
  }
}

}  // namespace resting_lattice_test
}  // namespace migiwa
