// The largest error of every method against quadratures that share no code with it (gamma_reference.h), for
// walls and kernels of all kinds. Run with --gtest_filter=GammaAccuracy.* to see the table that the README
// quotes.
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "core/boundary/box.h"
#include "core/boundary/gamma_method.h"
#include "core/boundary/plane.h"
#include "core/boundary/polynomial.h"
#include "core/boundary/sphere.h"
#include "tests/boundary/gamma_reference.h"

namespace migiwa {
namespace {

using Surfaces = std::vector<std::shared_ptr<const Surface>>;

constexpr double kSupport = 0.1;
constexpr std::array kKernels{KernelType::poly6, KernelType::spiky, KernelType::cubicSpline,
                              KernelType::wendlandC2};

/// Points in units of the support radius, with the gamma there.
struct Case {
  std::string name;
  Boundary boundary;
  std::vector<Vec3d> points;
  std::vector<double> truth;
};

double errorOf(const Case& walls, KernelType kernel, std::string_view method, int directions = 256) {
  const auto names = gammaMethodNames();
  const auto index = static_cast<int>(std::find(names.begin(), names.end(), method) - names.begin());
  const PickedGamma picked =
      makeGammaMethod(index, {walls.boundary, kernel, static_cast<float>(kSupport), directions, 200000});
  std::vector<Float4> points;
  for (const Vec3d& p : walls.points) points.emplace_back((kSupport * p).cast<float>());
  std::vector<GammaSample> samples(points.size());
  picked.method->evaluate(points, samples);
  double largest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(samples[i].gamma) - walls.truth[i]));
  return largest;
}

struct Errors {
  double automatic, directions256, directions1024, copula, product, mean;
};

Errors table(const Case& walls, KernelType kernel) {
  const Errors errors{errorOf(walls, kernel, "auto"),
                      errorOf(walls, kernel, "directions", 256),
                      errorOf(walls, kernel, "directions", 1024),
                      errorOf(walls, kernel, "copula"),
                      errorOf(walls, kernel, "product"),
                      errorOf(walls, kernel, "mean")};
  std::printf("%-22s %-12s auto %.4f  directions %.4f / %.4f  copula %.4f  product %.4f  mean %.3f\n",
              walls.name.c_str(), std::string(kKernelNames[static_cast<std::size_t>(kernel)]).c_str(),
              errors.automatic, errors.directions256, errors.directions1024, errors.copula, errors.product,
              errors.mean);
  EXPECT_LE(errors.directions256, 0.013) << walls.name;
  EXPECT_LE(errors.directions1024, 0.004) << walls.name;
  return errors;
}

/// Up to `count` points for which `distance` is between 0 and 1 and that `inside` accepts.
template <class Inside>
std::vector<Vec3d> randomPoints(std::size_t count, const Vec3d& low, const Vec3d& high,
                                const Inside& inside) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3d> points;
  while (points.size() < count) {
    const Vec3d p = low + Vec3d(unit(random), unit(random), unit(random)).cwiseProduct(high - low);
    if (inside(p)) points.push_back(p);
  }
  return points;
}

TEST(GammaAccuracy, OnePlane) {
  for (const KernelType kernel : kKernels) {
    const Vec3d normal = Vec3d(1, 2, -0.5).normalized();
    Case walls{"plane", Boundary(Surfaces{std::make_shared<Plane>(Vec3d::Zero(), normal)}), {}, {}};
    for (int k = 0; k <= 40; ++k) {
      const double e = k / 40.0;
      walls.points.emplace_back(e * normal);
      // The mass of a shell of radius r on the fluid side: all of it, less the cap beyond the plane.
      const auto shell = [&](double r) {
        return 4 * std::numbers::pi * r * r * reference::kernel(kernel, r) * 0.5 * (1 + std::min(1.0, e / r));
      };
      walls.truth.push_back(quadrature::integrate(0, std::min(e, 0.5), 4, shell) +
                            quadrature::integrate(std::min(e, 0.5), e, 4, shell) +
                            quadrature::integrate(e, std::max(e, 0.5), 4, shell) +
                            quadrature::integrate(std::max(e, 0.5), 1, 4, shell));
    }
    EXPECT_LT(table(walls, kernel).automatic, 1e-5);
  }
}

TEST(GammaAccuracy, Wedges) {
  for (const KernelType kernel : kKernels) {
    const reference::Wedge wedge(kernel);
    for (const double degrees : {30.0, 60.0, 90.0, 120.0, 150.0}) {
      const double angle = degrees * std::numbers::pi / 180;
      const Vec3d first(0, 1, 0), second(std::sin(angle), -std::cos(angle), 0);
      Case walls{"wedge " + std::to_string(static_cast<int>(degrees)),
                 Boundary(Surfaces{std::make_shared<Plane>(Vec3d::Zero(), first),
                                   std::make_shared<Plane>(Vec3d::Zero(), second)}),
                 randomPoints(
                     80, {-1, 0, 0}, {1, 1, 0},
                     [&](const Vec3d& p) { return first.dot(p) > 0 && second.dot(p) > 0 && p.norm() < 1.2; }),
                 {}};
      walls.points.emplace_back(1e-5 *
                                (first + second));  // the edge itself: gamma is its angle over a full turn
      for (const Vec3d& p : walls.points)
        walls.truth.push_back(wedge.gamma(first, first.dot(p), second, second.dot(p), true));
      EXPECT_NEAR(walls.truth.back(), degrees / 360, 1e-4);
      const Errors errors = table(walls, kernel);
      EXPECT_LE(errors.automatic, 0.004);
      EXPECT_LE(errors.copula, 0.004);
      if (degrees == 90) {
        EXPECT_NEAR(errors.mean, 0.25, 0.02) << "Figure 3 of the paper";
      }
    }
  }
}

TEST(GammaAccuracy, ConvexEdge) {
  for (const KernelType kernel : kKernels) {
    const reference::Wedge wedge(kernel);
    Case walls{
        "convex edge",
        Boundary(Surfaces{std::make_shared<Box>(Vec3d(-1, -1, -1), Vec3d(0, 0, 1), Box::Fluid::outside)}),
        randomPoints(80, {-1, -1, 0}, {1, 1, 0}, [](const Vec3d& p) { return p.x() > 0 || p.y() > 0; }),
        {}};
    for (const Vec3d& p : walls.points)
      walls.truth.push_back(wedge.gamma(Vec3d::UnitX(), p.x(), Vec3d::UnitY(), p.y(), false));
    EXPECT_LE(table(walls, kernel).automatic, 0.004);
  }
}

TEST(GammaAccuracy, Corners) {
  const std::array<std::array<Vec3d, 3>, 2> corners{
      {{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)},
       {Vec3d(1, 0.2, 0.1).normalized(), Vec3d(-0.4, 1, 0.3).normalized(),
        Vec3d(0.1, -0.5, 1).normalized()}}};
  for (const KernelType kernel : kKernels) {
    const reference::MassTable mass(kernel);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const auto& normals = corners[c];
      Surfaces surfaces;
      for (const Vec3d& normal : normals) surfaces.push_back(std::make_shared<Plane>(Vec3d::Zero(), normal));
      Case walls{c == 0 ? "corner" : "oblique corner",
                 Boundary(surfaces),
                 randomPoints(12, {-0.2, -0.2, -0.2}, {0.6, 0.6, 0.6},
                              [&](const Vec3d& p) {
                                return std::all_of(normals.begin(), normals.end(),
                                                   [&](const Vec3d& n) { return n.dot(p) > 0; });
                              }),
                 {}};
      for (const Vec3d& p : walls.points) {
        walls.truth.push_back(reference::overDirections([&](const Vec3d& w) {
          double hit = 2;
          for (const Vec3d& n : normals) hit = std::min(hit, reference::hitOf({n, n.dot(p)}, w));
          return mass(hit);
        }));
      }
      EXPECT_LE(table(walls, kernel).automatic, 0.01);
    }
  }
}

TEST(GammaAccuracy, SpheresInsideAndOutside) {
  for (const KernelType kernel : kKernels) {
    for (const double radius : {2.0, 4.0, 10.0}) {
      for (const Sphere::Fluid fluid : {Sphere::Fluid::inside, Sphere::Fluid::outside}) {
        const bool inside = fluid == Sphere::Fluid::inside;
        Case walls{
            (inside ? "inside sphere " : "outside sphere ") + std::to_string(static_cast<int>(radius)) + "h",
            Boundary(Surfaces{std::make_shared<Sphere>(Vec3d::Zero(), radius * kSupport, fluid)}),
            {},
            {}};
        for (int k = 0; k <= 20; ++k) {
          const double offset = radius + (inside ? -1 : 1) * k / 20.0;
          walls.points.emplace_back(offset * Vec3d(0.3, 0.5 + 0.1 * k, -0.8).normalized());
          const double within = reference::insideSphere(kernel, offset, radius);
          walls.truth.push_back(inside ? within : 1 - within);
        }
        EXPECT_LE(table(walls, kernel).automatic, 0.01);
      }
    }
  }
}

TEST(GammaAccuracy, PolynomialsOfDegreeTwoAndThree) {
  // z = sum c x^i y^j, in support radii; curvature radii of 2 to 4 h.
  struct Shape {
    const char* name;
    std::vector<Polynomial::Term> terms;
  };
  const std::vector<Shape> shapes{{"bowl", {{2, 0, 0.25}, {0, 2, 0.125}}},
                                  {"dome", {{2, 0, -0.25}, {0, 2, -0.125}}},
                                  {"saddle", {{2, 0, 0.25}, {0, 2, -0.25}, {1, 1, 0.1}}},
                                  {"cubic", {{3, 0, 0.15}, {1, 2, -0.1}, {2, 0, 0.1}, {1, 0, 0.2}}}};
  const KernelType kernel = KernelType::poly6;
  const reference::MassTable mass(kernel);
  for (const Shape& shape : shapes) {
    const auto height = [&](double x, double y) {
      double z = 0;
      for (const auto& [i, j, c] : shape.terms) z += c * std::pow(x, i) * std::pow(y, j);
      return z;
    };
    // A coefficient of x^i y^j in metres: lengths scale with the support radius.
    std::vector<Polynomial::Term> metres = shape.terms;
    for (Polynomial::Term& term : metres) term[2] *= std::pow(kSupport, 1 - term[0] - term[1]);
    Case walls{shape.name,
               Boundary(Surfaces{std::make_shared<Polynomial>(Vec3d::Zero(), Vec3d::UnitZ(), Vec3d::UnitX(),
                                                              4 * kSupport, metres)}),
               {},
               {}};
    for (int k = 0; k < 12; ++k) {
      const double x = 0.5 * std::cos(2.4 * k), y = 0.5 * std::sin(2.4 * k);
      const Vec3d p(x, y, height(x, y) + 0.02 + 0.08 * k);
      walls.points.push_back(p);
      walls.truth.push_back(reference::overDirections(
          [&](const Vec3d& w) {
            // March, bisect each change of sign, and add up what is fluid in between.
            const auto above = [&](double t) {
              return p.z() + t * w.z() - height(p.x() + t * w.x(), p.y() + t * w.y());
            };
            constexpr int kSteps = 24;
            double fluid = 0, from = 0;
            bool inFluid = true;
            for (int step = 1; step <= kSteps; ++step) {
              double low = (step - 1.0) / kSteps, high = static_cast<double>(step) / kSteps;
              if ((above(high) >= 0) == inFluid) continue;
              for (int halving = 0; halving < 30; ++halving) {
                const double middle = 0.5 * (low + high);
                ((above(middle) >= 0) == inFluid ? low : high) = middle;
              }
              if (inFluid) fluid += mass(low) - mass(from);
              from = low;
              inFluid = !inFluid;
            }
            return inFluid ? fluid + mass(1) - mass(from) : fluid;
          },
          8));
    }
    EXPECT_LE(table(walls, kernel).automatic, 0.01);
  }
}

TEST(GammaAccuracy, MonteCarloConvergesOnASphere) {
  Case walls{"sphere 3h",
             Boundary(Surfaces{std::make_shared<Sphere>(Vec3d::Zero(), 3 * kSupport, Sphere::Fluid::inside)}),
             {Vec3d(2.5, 0, 0), Vec3d(0, -2.1, 0), Vec3d(1.6, 1.6, 1.6)},
             {}};
  for (const Vec3d& p : walls.points)
    walls.truth.push_back(reference::insideSphere(KernelType::poly6, p.norm(), 3));
  EXPECT_LT(errorOf(walls, KernelType::poly6, "monte_carlo"), 5e-4);
}

}  // namespace
}  // namespace migiwa
