// The largest error of every method against quadratures that share no code with it (gamma_reference.h), for
// walls and kernels of all kinds. Run it to see the table that docs/gamma.md quotes.
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "core/gamma/gamma_method.h"
#include "core/walls/shapes.h"
#include "tests/gamma/gamma_reference.h"

namespace migiwa {
namespace gamma_accuracy_test {

using Surfaces = std::vector<std::shared_ptr<const Surface>>;

using reference::kKernels;
using reference::kSupport;

/// Points in units of the support radius, with the gamma there, and its gradient at some.
struct Case {
  std::string name;
  Boundary boundary;
  std::vector<Vec3d> points;
  std::vector<double> truth;
  std::vector<std::pair<std::size_t, Vec3d>> gradients;

  template <class Gamma>
  void fill(const Gamma& gamma) {
    for (const Vec3d& p : points) truth.push_back(gamma(p));
  }
  /// At `count` of the points whose neighbourhood is fluid.
  template <class Gamma>
  void fillGradients(std::size_t count, const Gamma& gamma) {
    for (std::size_t i = 0; i < points.size() && gradients.size() < count; ++i)
      if (boundary.distance((kSupport * points[i]).cast<float>()) > 0.05F * static_cast<float>(kSupport))
        gradients.emplace_back(i, reference::gradientOf(gamma, points[i]));
  }
};

/// The largest errors of gamma, and of its gradient times the support radius.
struct Error {
  double gamma = 0, gradient = 0;
};

Error errorOf(const Case& walls, KernelType kernel, std::string_view method, int directions = 256) {
  const auto names = gammaMethodNames();
  const auto index = static_cast<int>(std::find(names.begin(), names.end(), method) - names.begin());
  Bounds region;
  for (const Vec3d& p : walls.points) region.include(kSupport * p);
  const PickedGamma picked = makeGammaMethod(
      index, {walls.boundary, kernel, static_cast<float>(kSupport), directions, 200000, region});
  std::vector<Float4> points;
  for (const Vec3d& p : walls.points) points.emplace_back((kSupport * p).cast<float>());
  std::vector<GammaSample> samples(points.size());
  picked.method->evaluate(points, samples);
  Error largest;
  for (std::size_t i = 0; i < samples.size(); ++i)
    largest.gamma = std::max(largest.gamma, std::abs(static_cast<double>(samples[i].gamma) - walls.truth[i]));
  for (const auto& [i, gradient] : walls.gradients)
    largest.gradient = std::max(largest.gradient, (samples[i].gradient.cast<double>() - gradient).norm());
  return largest;
}

struct Errors {
  Error automatic, directions256, directions1024, baked, copula, product, mean;
};

Errors table(const Case& walls, KernelType kernel) {
  const Errors errors{errorOf(walls, kernel, "auto"),
                      errorOf(walls, kernel, "directions", 256),
                      errorOf(walls, kernel, "directions", 1024),
                      errorOf(walls, kernel, "baked"),
                      errorOf(walls, kernel, "copula"),
                      errorOf(walls, kernel, "product"),
                      errorOf(walls, kernel, "mean")};
  std::printf(
      "%-18s %-12s gamma: auto %.4f  directions %.4f / %.4f  baked %.4f  copula %.4f  product %.4f  mean "
      "%.3f   "
      "gradient: auto %.3f  directions %.3f / %.3f  baked %.3f\n",
      walls.name.c_str(), std::string(kKernelNames[static_cast<std::size_t>(kernel)]).c_str(),
      errors.automatic.gamma, errors.directions256.gamma, errors.directions1024.gamma, errors.baked.gamma,
      errors.copula.gamma, errors.product.gamma, errors.mean.gamma, errors.automatic.gradient,
      errors.directions256.gradient, errors.directions1024.gradient, errors.baked.gradient);
  EXPECT_FALSE(walls.gradients.empty()) << walls.name;
  EXPECT_LE(errors.automatic.gamma, 0.01) << walls.name;
  EXPECT_LE(errors.automatic.gradient, 0.05) << walls.name;
  EXPECT_LE(errors.directions256.gamma, 0.013) << walls.name;
  EXPECT_LE(errors.directions1024.gamma, 0.004) << walls.name;
  EXPECT_LE(errors.baked.gamma, 0.005) << walls.name;
  return errors;
}

/// Up to `count` points between low and high that `inside` accepts.
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
    Case walls{"plane", Boundary(Surfaces{std::make_shared<Plane>(Vec3d::Zero(), normal)}), {}, {}, {}};
    for (int k = 0; k <= 40; ++k) walls.points.emplace_back(k / 40.0 * normal);
    const auto truth = [&](const Vec3d& p) {
      const double e = normal.dot(p);
      if (e >= 1) return 1.0;
      // The mass of a shell of radius r on the fluid side: all of it, less the cap beyond the plane.
      const auto shell = [&](double r) {
        return 4 * std::numbers::pi * r * r * reference::kernel(kernel, r) * 0.5 * (1 + std::min(1.0, e / r));
      };
      return quadrature::integrate(0, std::min(e, 0.5), 4, shell) +
             quadrature::integrate(std::min(e, 0.5), e, 4, shell) +
             quadrature::integrate(e, std::max(e, 0.5), 4, shell) +
             quadrature::integrate(std::max(e, 0.5), 1, 4, shell);
    };
    walls.fill(truth);
    walls.fillGradients(40, truth);
    EXPECT_LT(table(walls, kernel).automatic.gamma, 1e-5);
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
                 {},
                 {}};
      walls.points.emplace_back(1e-5 *
                                (first + second));  // the edge itself: gamma is its angle over a full turn
      const auto truth = [&](const Vec3d& p) {
        return wedge.gamma(first, first.dot(p), second, second.dot(p), true);
      };
      walls.fill(truth);
      walls.fillGradients(12, truth);
      EXPECT_NEAR(walls.truth.back(), degrees / 360, 1e-4);
      const Errors errors = table(walls, kernel);
      EXPECT_LE(errors.automatic.gamma, 0.004);
      EXPECT_LE(errors.copula.gamma, 0.004);
      if (degrees == 90) {
        EXPECT_NEAR(errors.mean.gamma, 0.25, 0.02) << "Figure 3 of the paper";
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
        {},
        {}};
    const auto truth = [&](const Vec3d& p) {
      return wedge.gamma(Vec3d::UnitX(), p.x(), Vec3d::UnitY(), p.y(), false);
    };
    walls.fill(truth);
    walls.fillGradients(20, truth);
    EXPECT_LE(table(walls, kernel).automatic.gamma, 0.004);
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
                 randomPoints(6, {-0.2, -0.2, -0.2}, {0.6, 0.6, 0.6},
                              [&](const Vec3d& p) {
                                return std::all_of(normals.begin(), normals.end(),
                                                   [&](const Vec3d& n) { return n.dot(p) > 0; });
                              }),
                 {},
                 {}};
      const auto within = [&](const Vec3d& p, double tolerance) {
        return reference::overDirections(
            [&](const Vec3d& w) {
              double hit = 2;
              for (const Vec3d& n : normals) hit = std::min(hit, reference::hitOf({n, n.dot(p)}, w));
              return mass(hit);
            },
            tolerance);
      };
      walls.fill([&](const Vec3d& p) { return within(p, 1e-7); });
      walls.fillGradients(1, [&](const Vec3d& p) { return within(p, 1e-6); });
      table(walls, kernel);
    }
  }
}

TEST(GammaAccuracy, ThinPlate) {
  // A plate of 0.25 h whose rim runs along z; only what is seen past it counts.
  const Vec3d low(-3, -0.25, -3), high(0, 0, 3);
  for (const KernelType kernel : kKernels) {
    const reference::MassTable mass(kernel);
    Case walls{
        "plate of 0.25 h",
        Boundary(Surfaces{std::make_shared<Box>(kSupport * low, kSupport * high, Box::Fluid::outside)}),
        randomPoints(12, {-1, -1, 0}, {0.6, 0.8, 0},
                     [&](const Vec3d& p) { return p.x() > 0 || p.y() > 0 || p.y() < low.y(); }),
        {},
        {}};
    const auto seen = [&](const Vec3d& p, double tolerance) {
      return reference::overDirections(
          [&](const Vec3d& w) { return mass(std::min(reference::entryOf(low, high, p, w), 1.0)); },
          tolerance);
    };
    walls.fill([&](const Vec3d& p) { return seen(p, 1e-6); });
    walls.fillGradients(2, [&](const Vec3d& p) { return seen(p, 1e-6); });
    table(walls, kernel);
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
            {},
            {}};
        for (int k = 0; k <= 20; ++k) {
          const double offset = radius + (inside ? -1 : 1) * k / 20.0;
          walls.points.emplace_back(offset * Vec3d(0.3, 0.5 + 0.02 * k, -0.8).normalized());
        }
        const auto truth = [&](const Vec3d& p) {
          const double within = reference::insideSphere(kernel, p.norm(), radius);
          return inside ? within : 1 - within;
        };
        walls.fill(truth);
        walls.fillGradients(20, truth);
        table(walls, kernel);
      }
    }
  }
}

class PolynomialAccuracy : public ::testing::TestWithParam<KernelType> {};

TEST_P(PolynomialAccuracy, OfDegreeTwoAndThree) {
  // z = sum c x^i y^j, in support radii; curvature radii of 2 to 4 h.
  struct Shape {
    const char* name;
    std::vector<Polynomial::Term> terms;
  };
  const std::vector<Shape> shapes{{"bowl", {{2, 0, 0.25}, {0, 2, 0.125}}},
                                  {"dome", {{2, 0, -0.25}, {0, 2, -0.125}}},
                                  {"saddle", {{2, 0, 0.25}, {0, 2, -0.25}, {1, 1, 0.1}}},
                                  {"cubic", {{3, 0, 0.15}, {1, 2, -0.1}, {2, 0, 0.1}, {1, 0, 0.2}}}};
  const KernelType kernel = GetParam();
  const reference::MassTable mass(kernel);
  const int points = kernel == KernelType::poly6 ? 6 : 3;
  for (const Shape& shape : shapes) {
    const auto height = [&](double x, double y) {
      const double px[] = {1, x, x * x, x * x * x}, py[] = {1, y, y * y, y * y * y};
      double z = 0;
      for (const auto& [i, j, c] : shape.terms)
        z += c * px[static_cast<std::size_t>(i)] * py[static_cast<std::size_t>(j)];
      return z;
    };
    // A coefficient of x^i y^j in metres: lengths scale with the support radius.
    std::vector<Polynomial::Term> metres = shape.terms;
    for (Polynomial::Term& term : metres) term[2] *= std::pow(kSupport, 1 - term[0] - term[1]);
    Case walls{shape.name,
               Boundary(Surfaces{std::make_shared<Polynomial>(Vec3d::Zero(), Vec3d::UnitZ(), Vec3d::UnitX(),
                                                              4 * kSupport, metres)}),
               {},
               {},
               {}};
    for (int k = 0; k < points; ++k) {
      const double x = 0.5 * std::cos(2.4 * k), y = 0.5 * std::sin(2.4 * k);
      walls.points.emplace_back(x, y, height(x, y) + 0.02 + 0.96 / points * k);
    }
    const auto truth = [&](const Vec3d& p, double tolerance) {
      return reference::overDirections(
          [&](const Vec3d& w) {
            // March, bisect each change of sign, and add up what is fluid in between.
            const auto above = [&](double t) {
              return p.z() + t * w.z() - height(p.x() + t * w.x(), p.y() + t * w.y());
            };
            constexpr int kSteps = 16;
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
          tolerance);
    };
    walls.fill([&](const Vec3d& p) { return truth(p, 1e-6); });
    walls.fillGradients(1, [&](const Vec3d& p) { return truth(p, 1e-5); });
    table(walls, kernel);
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, PolynomialAccuracy,
                         ::testing::Values(KernelType::poly6, KernelType::spiky, KernelType::cubicSpline,
                                           KernelType::wendlandC2));

TEST(GammaAccuracy, MonteCarloConvergesOnASphere) {
  Case walls{"sphere 3h",
             Boundary(Surfaces{std::make_shared<Sphere>(Vec3d::Zero(), 3 * kSupport, Sphere::Fluid::inside)}),
             {Vec3d(2.5, 0, 0), Vec3d(0, -2.1, 0), Vec3d(1.6, 1.6, 1.6)},
             {},
             {}};
  walls.fill([](const Vec3d& p) { return reference::insideSphere(KernelType::poly6, p.norm(), 3); });
  EXPECT_LT(errorOf(walls, KernelType::poly6, "monte_carlo").gamma, 5e-4);
}

TEST(GammaReference, AgreesWithItselfAndWithClosedForms) {
  const KernelType kernel = KernelType::spiky;
  const reference::MassTable mass(kernel);
  const reference::Wedge wedge(kernel);
  // A corner seen from its own tip: its solid angle. An edge, a sphere: the other quadratures.
  const auto corner = [&](const Vec3d& p, int planes) {
    return reference::overDirections([&](const Vec3d& w) {
      double hit = 2;
      for (int axis = 0; axis < planes; ++axis)
        hit = std::min(hit, reference::hitOf({Vec3d::Unit(axis), p[axis]}, w));
      return mass(hit);
    });
  };
  EXPECT_NEAR(corner(Vec3d::Constant(1e-9), 3), 0.125, 1e-6);
  const Vec3d p(0.2, 0.35, 0);
  EXPECT_NEAR(corner(p, 2), wedge.gamma(Vec3d::UnitX(), p.x(), Vec3d::UnitY(), p.y(), true), 1e-6);
  const double radius = 2, offset = 1.7;
  EXPECT_NEAR(reference::overDirections([&](const Vec3d& w) {
                const double b = offset * w.x();
                return mass(std::sqrt(b * b + radius * radius - offset * offset) - b);
              }),
              reference::insideSphere(kernel, offset, radius), 1e-6);
}

}  // namespace gamma_accuracy_test
}  // namespace migiwa
