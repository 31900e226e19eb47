// Walls thinner than the support radius: gamma counts only the fluid that a point sees, against quadratures
// of that definition.
#include <random>

#include <gtest/gtest.h>

#include "core/gamma/gamma_method.h"
#include "core/walls/shapes.h"
#include "tests/gamma/gamma_reference.h"

namespace migiwa {
namespace gamma_thin_wall_test {

using Surfaces = std::vector<std::shared_ptr<const Surface>>;

constexpr float kSupport = 0.1F;

GammaSample sampleAt(const Boundary& boundary, std::string_view method, const Vec3d& p) {
  const auto names = gammaMethodNames();
  const auto index = static_cast<int>(std::find(names.begin(), names.end(), method) - names.begin());
  const PickedGamma picked = makeGammaMethod(index, {boundary, KernelType::poly6, kSupport, 1024, 200000});
  const Float4 point(p.cast<float>());
  GammaSample sample;
  picked.method->evaluate({&point, 1}, {&sample, 1});
  return sample;
}

void expectSame(const GammaSample& a, const GammaSample& b, float tolerance) {
  EXPECT_NEAR(a.gamma, b.gamma, tolerance);
  EXPECT_NEAR(a.distance, b.distance, 1e-6F);
  EXPECT_LT((a.gradient - b.gradient).norm(), 10 * tolerance);
  EXPECT_LT((a.pairGradient - b.pairGradient).norm(), 10 * tolerance);
}

const std::shared_ptr<const Box> kPlate =
    std::make_shared<Box>(Vec3d(-1, 0, -1), Vec3d(1, 0.025, 1), Box::Fluid::outside);

TEST(GammaThinWall, EitherSideOfAPlateIsThatOfAPlane) {
  const Boundary plate(Surfaces{kPlate});
  const Boundary top(Surfaces{std::make_shared<Plane>(Vec3d(0, 0.025, 0), Vec3d::UnitY())});
  const Boundary bottom(Surfaces{std::make_shared<Plane>(Vec3d::Zero(), -Vec3d::UnitY())});
  for (const std::string_view method : {"auto", "product", "copula", "directions", "monte_carlo"}) {
    for (const double e : {0.0, 0.1, 0.25, 0.5, 0.9, 1.0, 1.3}) {
      SCOPED_TRACE(std::string(method) + " at " + std::to_string(e));
      const float tolerance = method == "monte_carlo" ? 1e-5F : 1e-6F;
      const double d = 0.1 * e;
      const Vec3d above(0.1, 0.025 + d, 0.2), below(0.1, -d, 0.2);
      expectSame(sampleAt(plate, method, above), sampleAt(top, method, above), tolerance);
      expectSame(sampleAt(plate, method, below), sampleAt(bottom, method, below), tolerance);
    }
  }
}

TEST(GammaThinWall, APlateThatSpansATankActsLikeAWallOfIt) {
  // Its rim lies in the tank's walls, or inside them.
  for (const double into : {0.0, 0.03}) {
    const auto tank = std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(1, 1, 1), Box::Fluid::inside);
    const auto plate = std::make_shared<Box>(Vec3d(0.5, -into, -into), Vec3d(0.525, 1 + into, 1 + into),
                                             Box::Fluid::outside);
    const auto half = std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(0.5, 1, 1), Box::Fluid::inside);
    const Boundary divided(Surfaces{tank, plate}), alone(Surfaces{half});
    for (const std::string_view method : {"auto", "product", "copula", "directions"}) {
      for (const Vec3d& p : {Vec3d(0.48, 0.03, 0.5), Vec3d(0.45, 0.5, 0.02), Vec3d(0.49, 0.05, 0.97)}) {
        SCOPED_TRACE(std::string(method) + " at " + std::to_string(p.x()));
        // Rays against a box and against planes differ in a few grazing directions.
        expectSame(sampleAt(divided, method, p), sampleAt(alone, method, p),
                   method == "directions" ? 1e-5F : 1e-6F);
      }
    }
  }
}

TEST(GammaThinWall, NearItsRimOnlyWhatIsSeenCounts) {
  const Vec3d low(-3, -0.25, -3), high(0, 0, 3);  // in support radii, its rim along z
  const auto h = static_cast<double>(kSupport);
  const Boundary plate(Surfaces{std::make_shared<Box>(h * low, h * high, Box::Fluid::outside)});
  const reference::MassTable mass(KernelType::poly6);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> coordinate(-0.8, 0.8);
  int evaluated = 0;
  while (evaluated < 24) {
    const Vec3d p(coordinate(random), coordinate(random), coordinate(random));
    if (plate.distance((h * p).cast<float>()) <= 0) continue;
    ++evaluated;
    const double truth = reference::overDirections(
        [&](const Vec3d& w) { return mass(std::min(reference::entryOf(low, high, p, w), 1.0)); }, 1e-6);
    for (const std::string_view method : {"auto", "directions"})
      EXPECT_NEAR(static_cast<double>(sampleAt(plate, method, h * p).gamma), truth, 0.005)
          << method << " at " << p.transpose();
    EXPECT_NEAR(static_cast<double>(sampleAt(plate, "monte_carlo", h * p).gamma), truth, 0.001)
        << p.transpose();
  }
}

TEST(GammaThinWall, ASmallBallHidesWhatIsBehindIt) {
  const double radius = 0.4;  // in support radii
  const Boundary ball(Surfaces{std::make_shared<Sphere>(Vec3d::Zero(), radius * static_cast<double>(kSupport),
                                                        Sphere::Fluid::outside)});
  const reference::MassTable mass(KernelType::poly6);
  for (const double offset : {0.41, 0.6, 0.9, 1.2}) {
    // About the line to the centre: rays within the ball's angle end on it.
    const double edge = std::sqrt(1 - radius * radius / (offset * offset));
    const double hidden = quadrature::integrate(edge, 1, 8, [&](double cosine) {
      const double hit = offset * cosine -
                         std::sqrt(std::max(radius * radius - offset * offset * (1 - cosine * cosine), 0.0));
      return 0.5 * (1 - mass(std::min(hit, 1.0)));
    });
    for (const std::string_view method : {"auto", "directions", "monte_carlo"})
      EXPECT_NEAR(static_cast<double>(
                      sampleAt(ball, method, Vec3d(0, offset * static_cast<double>(kSupport), 0)).gamma),
                  1 - hidden, 0.004)
          << method << " at " << offset;
  }
}

}  // namespace gamma_thin_wall_test
}  // namespace migiwa
