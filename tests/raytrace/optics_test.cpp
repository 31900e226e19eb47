// Interfaces against the formulas of textbooks, written another way, and random numbers against what even
// spreading means.
#include "app/raytrace/optics.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "app/raytrace/paths.h"
#include "tests/raytrace/stages.h"

namespace migiwa {
namespace optics_test {

constexpr double kPi = std::numbers::pi;

/// Fresnel's reflectance by angles: sin(i - t) / sin(i + t) and tan(i - t) / tan(i + t).
double reflectanceByAngles(double angle, double from, double to) {
  const double sine = from / to * std::sin(angle);
  if (sine >= 1) return 1;
  const double beyond = std::asin(sine);
  const double s = std::sin(angle - beyond) / std::sin(angle + beyond);
  const double p = std::tan(angle - beyond) / std::tan(angle + beyond);
  return (s * s + p * p) / 2;
}

Vec3f slanted(double angle) {
  return Vec3d(std::sin(angle), -std::cos(angle), 0).cast<float>();
}

TEST(Interface, ReflectsAndRefractsAsFresnelAndSnellSay) {
  for (const auto& [from, to] : {std::pair{Medium::air, Medium::water},
                                 {Medium::water, Medium::air},
                                 {Medium::air, Medium::glass},
                                 {Medium::glass, Medium::air},
                                 {Medium::water, Medium::glass},
                                 {Medium::glass, Medium::water}}) {
    const auto n1 = static_cast<double>(refractiveIndex(from)), n2 = static_cast<double>(refractiveIndex(to));
    for (int degrees = 1; degrees < 90; ++degrees) {
      const double angle = degrees * kPi / 180;
      const Interface optics =
          interfaceAt(slanted(angle), Vec3f::UnitY(), refractiveIndex(from), refractiveIndex(to));
      EXPECT_NEAR(optics.reflectance, reflectanceByAngles(angle, n1, n2), 1e-4)
          << n1 << " " << n2 << " " << degrees;
      if (optics.reflectance < 1) {
        EXPECT_NEAR(static_cast<double>(optics.refracted.x()) * n2, std::sin(angle) * n1, 1e-4);
      }
    }
  }
}

TEST(Interface, HeadOnItReflectsTheSquareOfTheRatio) {
  EXPECT_NEAR(interfaceAt(-Vec3f::UnitY(), Vec3f::UnitY(), 1, 1.5F).reflectance, 0.04, 1e-6);
}

TEST(Interface, WaterAtGlassIsOne) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  // 60 degrees in the water: 1.8 % as one interface does; with air between, it would be all of the light.
  const testing::WavyTank tank(40, 0);
  const Stage stage(tank.content());
  const double angle = kPi / 3;
  const Vec3f direction = Vec3d(-std::cos(angle), std::sin(angle) * 0.6, std::sin(angle) * 0.8).cast<float>();
  const Event event = stage.next({0.05F, 0.1F, 0.1F}, direction, {Medium::water});
  ASSERT_EQ(event.kind, Event::Kind::interface);
  EXPECT_EQ(event.before, Medium::water);
  ASSERT_EQ(event.beyond.medium, Medium::glass);
  const Interface optics = interfaceAt(direction, event.shading, refractiveIndex(event.before),
                                       refractiveIndex(event.beyond.medium));
  EXPECT_NEAR(optics.reflectance, reflectanceByAngles(angle, 1.333, 1.5), 1e-4);
  EXPECT_NEAR(optics.reflectance, 0.018, 5e-4);
}

TEST(Interface, TheStageTellsTheSidesOfTheWater) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  const testing::WavyTank tank(40, 0);
  const Stage stage(tank.content());
  const Event down = stage.next({0.4F, 0.7F, 0.3F}, slanted(0.3), {Medium::air});
  EXPECT_EQ(down.kind, Event::Kind::interface);
  EXPECT_EQ(down.before, Medium::air);
  EXPECT_EQ(down.beyond.medium, Medium::water);
  EXPECT_NEAR(down.point.y(), 0.35, 1e-6);
  const Event up = stage.next({0.4F, 0.2F, 0.3F}, -slanted(0.3), {Medium::water});
  EXPECT_EQ(up.before, Medium::water);
  EXPECT_EQ(up.beyond.medium, Medium::air);
  const Interface optics = interfaceAt(slanted(0.3), down.shading, refractiveIndex(down.before),
                                       refractiveIndex(down.beyond.medium));
  EXPECT_NEAR(optics.reflectance, reflectanceByAngles(0.3, 1, 1.333), 1e-4);
}

TEST(PixelSamples, EveryPowerOfTwoIsSpreadEvenly) {
  // A (0, 2) sequence: of 2^(a + b) samples one lies in every cell of 2^a by 2^b.
  constexpr std::uint32_t kCount = 64;
  for (std::uint32_t pixel = 0; pixel < 20; ++pixel) {
    for (int dimension = 0; dimension < 5; ++dimension) {
      for (std::uint32_t a = 0; a <= 6; ++a) {
        std::set<std::uint32_t> cells;
        for (std::uint32_t k = 0; k < kCount; ++k) {
          PixelSamples random(7, pixel, k, kCount);
          std::pair<float, float> place;
          for (int d = 0; d <= dimension; ++d) place = random.next();
          ASSERT_GE(place.first, 0);
          ASSERT_LT(place.first, 1);
          cells.insert(static_cast<std::uint32_t>(place.first * static_cast<float>(1U << a)) << 16U |
                       static_cast<std::uint32_t>(place.second * static_cast<float>(kCount >> a)));
        }
        ASSERT_EQ(cells.size(), kCount) << pixel << " " << dimension << " " << a;
      }
    }
  }
}

TEST(PixelSamples, PixelsAndDimensionsAreIndependent) {
  double across = 0, between = 0;
  constexpr int kCount = 20000;
  for (int k = 0; k < kCount; ++k) {
    PixelSamples one(1, static_cast<std::uint32_t>(k), 0, 64),
        other(1, static_cast<std::uint32_t>(k + 1), 0, 64);
    const double a = static_cast<double>(one.next().first) - 0.5,
                 b = static_cast<double>(one.next().first) - 0.5,
                 c = static_cast<double>(other.next().first) - 0.5;
    across += 12 * a * b / kCount;
    between += 12 * a * c / kCount;
  }
  EXPECT_NEAR(across, 0, 4 / std::sqrt(kCount));
  EXPECT_NEAR(between, 0, 4 / std::sqrt(kCount));
}

}  // namespace optics_test
}  // namespace migiwa
