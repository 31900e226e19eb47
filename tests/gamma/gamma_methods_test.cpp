// gamma of the methods against a Gauss-Legendre quadrature of the kernel over the fluid, cut at the walls.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/gamma/gamma_method.h"
#include "core/walls/shapes.h"
#include "tests/sph/quadrature.h"

namespace migiwa {
namespace gamma_methods_test {

constexpr float kSupport = 0.1F;

double poly6(double q) {
  return q < 1 ? 315 / (64 * std::numbers::pi) * std::pow(1 - q * q, 3) : 0;
}

/// Integral of Poly6 of support 1 over the box [low, high] in coordinates relative to the kernel's centre.
double overBox(Vec3d low, Vec3d high) {
  low = low.cwiseMax(-1.0);
  high = high.cwiseMin(1.0);
  if ((low.array() >= high.array()).any()) return 0;
  constexpr int kPanels = 3;
  return quadrature::integrate(low.x(), high.x(), kPanels, [&](double x) {
    return quadrature::integrate(low.y(), high.y(), kPanels, [&](double y) {
      return quadrature::integrate(low.z(), high.z(), kPanels,
                                   [&](double z) { return poly6(std::sqrt(x * x + y * y + z * z)); });
    });
  });
}

int methodIndex(std::string_view name) {
  const auto names = gammaMethodNames();
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return static_cast<int>(k);
  ADD_FAILURE() << "no gamma method is called " << name;
  return 0;
}

GammaSample sampleAt(const GammaMethod& method, const Vec3f& p) {
  const Float4 point(p);
  GammaSample sample;
  method.evaluate({&point, 1}, {&sample, 1});
  return sample;
}

struct Walls {
  explicit Walls(std::vector<std::shared_ptr<const Surface>> surfaces) : boundary(std::move(surfaces)) {}
  PickedGamma make(std::string_view method, KernelType kernel = KernelType::poly6,
                   int directions = 1024) const {
    return makeGammaMethod(methodIndex(method), {boundary, kernel, kSupport, directions});
  }
  Boundary boundary;
};

Walls tank(double size) {
  return Walls({std::make_shared<Box>(Vec3d::Zero(), Vec3d::Constant(size), Box::Fluid::inside)});
}

/// Largest error of a method in a tank, against the integral over the tank, at points up to h from its
/// corner.
double largestErrorInTank(std::string_view name, double size, const Vec3f& from, const Vec3f& to) {
  const Walls walls = tank(size);
  const PickedGamma picked = walls.make(name);
  double largest = 0;
  constexpr int kSteps = 4;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k) {
        const Vec3f part =
            Vec3f(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)) / kSteps;
        const Vec3f p = from + part.cwiseProduct(to - from);
        const Vec3d relative = p.cast<double>() / static_cast<double>(kSupport);
        const double truth =
            overBox(-relative, Vec3d::Constant(size / static_cast<double>(kSupport)) - relative);
        largest = std::max(largest, std::abs(static_cast<double>(sampleAt(*picked.method, p).gamma) - truth));
      }
    }
  }
  return largest;
}

const Vec3f kCorner = Vec3f::Zero(), kAway = Vec3f::Constant(kSupport);

TEST(Gamma, EveryMethodIsRightAtOnePlane) {
  for (const std::string_view name : gammaMethodNames()) {
    const double bound = name == "monte_carlo" ? 1e-3 : name == "baked" ? 5e-4 : 1e-5;
    EXPECT_LT(largestErrorInTank(name, 1, {0, 0.5F, 0.5F}, {kSupport, 0.5F, 0.5F}), bound) << name;
  }
}

TEST(Gamma, ProductIsExactBetweenParallelPlanes) {
  EXPECT_LT(largestErrorInTank("product", 1, {0, 0.5F, 0.5F}, {0.01F, 0.5F, 0.5F}), 1e-5);
  // A slit of 0.8 h: both walls cut the kernel everywhere.
  const Walls slit({std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY()),
                    std::make_shared<Plane>(Vec3d(0, 0.08, 0), -Vec3d::UnitY())});
  const PickedGamma picked = slit.make("product");
  for (const float y : {0.0F, 0.01F, 0.03F, 0.04F, 0.08F}) {
    const double low = static_cast<double>(-y / kSupport), high = static_cast<double>((0.08F - y) / kSupport);
    EXPECT_NEAR(static_cast<double>(sampleAt(*picked.method, {0, y, 0}).gamma),
                overBox({-1, low, -1}, {1, high, 1}), 1e-5);
  }
}

TEST(Gamma, ProductKeepsItsBoundsAtEdgesAndCorners) {
  const Vec3f edge(0, 0, 0.5F), awayFromEdge(kSupport, kSupport, 0.5F);
  EXPECT_LT(largestErrorInTank("product", 1, edge, awayFromEdge), 0.004);
  EXPECT_LT(largestErrorInTank("product", 1, kCorner, kAway), 0.008);
}

TEST(Gamma, MeanAndNearestErrByAQuarterAtAnEdgeAsInFigure3) {
  const Vec3f edge(0, 0, 0.5F), awayFromEdge(kSupport, kSupport, 0.5F);
  for (const std::string_view name : {"mean", "nearest"}) {
    const double error = largestErrorInTank(name, 1, edge, awayFromEdge);
    EXPECT_NEAR(error, 0.25, 0.01) << name;
    EXPECT_NEAR(largestErrorInTank(name, 1, kCorner, kAway), 0.385, 0.01) << name;
  }
}

TEST(Gamma, ProductAtABlockMatchesTheKernelAroundIt) {
  const Vec3d low(0, 0, 0), high(0.5, 0.12, 0.5);
  const Walls walls({std::make_shared<Box>(low, high, Box::Fluid::outside)});
  const PickedGamma picked = walls.make("product");
  const auto h = static_cast<double>(kSupport);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> coordinate(-0.1, 0.6);
  int evaluated = 0;
  for (int k = 0; k < 2000 && evaluated < 60; ++k) {
    const Vec3d p(coordinate(random), 0.4 * coordinate(random), coordinate(random));
    const double d = static_cast<double>(walls.boundary.distance(p.cast<float>()));
    if (d < 0 || d > h) continue;
    ++evaluated;
    const double truth = 1 - overBox((low - p) / h, (high - p) / h);
    EXPECT_NEAR(static_cast<double>(sampleAt(*picked.method, p.cast<float>()).gamma), truth, 0.008)
        << p.transpose();
  }
  EXPECT_EQ(evaluated, 60);
}

TEST(Gamma, GradientIsTheDerivativeForEveryMethodAndKernel) {
  const Walls walls(
      {std::make_shared<Box>(Vec3d::Zero(), Vec3d::Ones(), Box::Fluid::inside, Rotation{{1, 1, 0}, 20}),
       std::make_shared<Box>(Vec3d(0.4, 0.3, 0.4), Vec3d(0.6, 0.42, 0.6), Box::Fluid::outside)});
  std::mt19937 random(5);
  std::uniform_real_distribution<float> coordinate(0, 1);
  constexpr float kStep = 2e-4F;
  for (const std::string_view name : {"product", "copula", "directions", "mean"}) {
    for (const KernelType kernel :
         {KernelType::poly6, KernelType::spiky, KernelType::cubicSpline, KernelType::wendlandC2}) {
      const PickedGamma picked = walls.make(name, kernel);
      // Over a step this small, a few directions jump on and off a wall: the differences need many.
      const PickedGamma fine = walls.make(name, kernel, 65536);
      int evaluated = 0;
      for (int k = 0; k < 20000 && evaluated < 40; ++k) {
        const Vec3f p(coordinate(random), coordinate(random), coordinate(random));
        const float d = walls.boundary.distance(p);
        if (d < 0.01F || d > 0.09F) continue;
        ++evaluated;
        const GammaSample sample = sampleAt(*picked.method, p);
        Vec3f difference;
        for (int axis = 0; axis < 3; ++axis) {
          const Vec3f step = kStep * Vec3f::Unit(axis);
          difference[axis] =
              (sampleAt(*fine.method, p + step).gamma - sampleAt(*fine.method, p - step).gamma) /
              (2 * kStep / kSupport);
        }
        // The mean jumps where a piece comes into reach: its weight is e^-2 there, not zero.
        if (name == "mean" && (difference - sample.gradient).norm() > 5) continue;
        EXPECT_LT((difference - sample.gradient).norm(), name == "directions" ? 0.05F : 0.01F)
            << name << " at " << p.transpose();
      }
      EXPECT_EQ(evaluated, 40);
    }
  }
}

TEST(Gamma, TheWallsPushComesFromThePairKernel) {
  const Walls walls({std::make_shared<Plane>(Vec3d::Zero(), Vec3d::UnitY())});
  // Poly6's pairs are Spiky's: K(e) = T^4 (3/2 + 6 e), here at e = 0.4.
  const double expected = std::pow(0.6, 4) * (1.5 + 6 * 0.4);
  for (const std::string_view name : gammaMethodNames()) {
    const GammaSample sample = sampleAt(*walls.make(name).method, {0.2F, 0.04F, 0});
    EXPECT_NEAR(static_cast<double>(sample.pairGradient.y()), expected, name == "monte_carlo" ? 5e-3 : 1e-5)
        << name;
    EXPECT_NEAR(static_cast<double>(sample.distance), 0.04, 1e-6) << name;
  }
}

TEST(Gamma, AutoSaysWhatItTookAndWhy) {
  const PickedGamma picked = tank(1).make("auto");
  EXPECT_EQ(picked.name, "product");
  EXPECT_FALSE(picked.reason.empty());
  EXPECT_TRUE(tank(1).make("mean").reason.empty());
}

/// Planes and facets are told apart by their last bits, for only facets sum over edges.
bool takesFacets(const Walls& walls, const GammaMethod& automatic) {
  const PickedGamma facets = walls.make("facets"), product = walls.make("product");
  Bounds bounds;
  for (const auto& surface : walls.boundary.surfaces()) bounds.include(surface->bounds());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 4000; ++k) {
    const Vec3d at(unit(random), unit(random), unit(random));
    const Vec3f p = (bounds.min + at.cwiseProduct(bounds.size())).cast<float>();
    const float distance = walls.boundary.distance(p);
    if (distance <= 0 || distance >= kSupport) continue;
    const GammaSample sample = sampleAt(automatic, p);
    if (sample.gamma == sampleAt(*facets.method, p).gamma &&
        sample.gamma != sampleAt(*product.method, p).gamma)
      return true;
  }
  return false;
}

TEST(Gamma, AutoNamesTheMethodsThatItTakesAndNoOthers) {
  const auto box = [](const Vec3d& min, const Vec3d& max, double degrees = 0) {
    const Rotation rotation{.axis = Vec3d::UnitZ(), .degrees = degrees};
    return std::make_shared<Box>(min, max, Box::Fluid::outside, rotation);
  };
  const auto vessel = std::make_shared<Box>(Vec3d::Zero(), Vec3d::Ones(), Box::Fluid::inside);
  const auto ball = std::make_shared<Sphere>(Vec3d::Constant(0.5), 0.25, Sphere::Fluid::outside);
  struct Case {
    std::vector<std::shared_ptr<const Surface>> surfaces;
    const char* name;
  };
  const Case cases[] = {
      {{vessel, ball}, "product, baked"},
      {{ball}, "baked"},
      {{vessel, box({0.4, 0, 0.3}, {0.45, 0.5, 0.7})}, "product, facets"},
      {{vessel, box({0.4, 0, 0.3}, {0.45, 0.5, 0.7}), ball}, "product, facets, baked"},
      {{vessel, box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6})}, "product"},
      {{vessel, box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}, 30)}, "product"},
      {{vessel, box({0.4, 0.1, 0.4}, {0.6, 0.3, 0.6}, 30)}, "product, facets"},
      {{vessel, box({0.3, 0.44, 0.44}, {0.41, 0.55, 0.55}, 30), box({0.6, 0.44, 0.44}, {0.71, 0.55, 0.55})},
       "product"},
  };
  for (const Case& one : cases) {
    const Walls walls(one.surfaces);
    const PickedGamma picked = walls.make("auto");
    EXPECT_EQ(picked.name, one.name);
    EXPECT_EQ(takesFacets(walls, *picked.method), picked.name.find("facets") != std::string::npos)
        << one.name << ": " << picked.reason;
  }
}

/// Of a kernel on the face of three blocks that overlap, each takes half, so that less than nothing is left.
TEST(Gamma, ASharePastItsRangeIsCounted) {
  std::vector<std::shared_ptr<const Surface>> blocks;
  for (int k = 0; k < 3; ++k)
    blocks.push_back(
        std::make_shared<Box>(Vec3d(-1, -1, -1), Vec3d(1 + 0.001 * k, 1, 1), Box::Fluid::outside));
  const Walls overlapping(blocks), one({blocks.front()});
  for (const std::string_view name : {"facets", "product", "auto"}) {
    const PickedGamma many = overlapping.make(name), single = one.make(name);
    EXPECT_EQ(sampleAt(*many.method, {0, 1.001F, 0}).gamma, 0.0F);
    EXPECT_EQ(many.method->takeOutOfRange(), 1) << name;
    EXPECT_EQ(many.method->takeOutOfRange(), 0) << name;
    EXPECT_GT(sampleAt(*single.method, {0, 1.001F, 0}).gamma, 0.4F);
    EXPECT_EQ(single.method->takeOutOfRange(), 0) << name;
  }
}

}  // namespace gamma_methods_test
}  // namespace migiwa
