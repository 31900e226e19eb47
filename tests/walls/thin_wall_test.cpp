// Which ways pass through a solid, against dense sampling of its distance.
#include <random>

#include <gtest/gtest.h>

#include "core/walls/shapes.h"

namespace migiwa {
namespace thin_wall_test {

TEST(ThinWall, ThicknessIsTheLeastWayThrough) {
  EXPECT_FLOAT_EQ(Box({0, 0, 0}, {1, 0.25, 2}, Box::Fluid::outside, Rotation{{1, 1, 0}, 30}).thickness(),
                  0.25F);
  EXPECT_FLOAT_EQ(Sphere({0, 0, 0}, 0.3, Sphere::Fluid::outside).thickness(), 0.6F);
  EXPECT_TRUE(std::isinf(Box({0, 0, 0}, {1, 1, 1}, Box::Fluid::inside).thickness()));
  EXPECT_TRUE(std::isinf(Sphere({0, 0, 0}, 1, Sphere::Fluid::inside).thickness()));
  EXPECT_TRUE(std::isinf(Plane({0, 0, 0}, {0, 1, 0}).thickness()));
}

/// Walks from one fluid point to another in small steps: how far along it first is in the solid, 2 if never.
float walk(const Surface& surface, const Vec3f& from, const Vec3f& to) {
  constexpr int kSteps = 2000;
  for (int k = 0; k <= kSteps; ++k) {
    const float t = static_cast<float>(k) / kSteps;
    Vec3f ignored;
    if (surface.distance(from + t * (to - from), ignored) < 0) return t;
  }
  return 2;
}

TEST(ThinWall, CrossingsAreThoseOfAWalkAlongTheWay) {
  const std::vector<std::shared_ptr<const Surface>> solids{
      std::make_shared<Box>(Vec3d(-0.5, -0.05, -0.4), Vec3d(0.5, 0.05, 0.4), Box::Fluid::outside),
      std::make_shared<Box>(Vec3d(-0.5, -0.05, -0.4), Vec3d(0.5, 0.05, 0.4), Box::Fluid::outside,
                            Rotation{{1, 2, -0.5}, 50}),
      std::make_shared<Sphere>(Vec3d(0.1, 0, -0.1), 0.3, Sphere::Fluid::outside)};
  std::mt19937 random(11);
  std::uniform_real_distribution<float> coordinate(-0.7F, 0.7F);
  for (const auto& solid : solids) {
    int crossed = 0, passed = 0, grazed = 0;
    for (int k = 0; k < 4000; ++k) {
      const Vec3f from(coordinate(random), coordinate(random), coordinate(random));
      const Vec3f to(coordinate(random), coordinate(random), coordinate(random));
      Vec3f normal;
      if (solid->distance(from, normal) <= 0 || solid->distance(to, normal) <= 0) continue;
      const float expected = walk(*solid, from, to);
      float entry = -1;
      const bool crosses = solid->crosses(from, to, normal, entry);
      if (expected > 1) {
        // The walk may step over a corner.
        ++(crosses ? grazed : passed);
        continue;
      }
      ASSERT_TRUE(crosses) << from.transpose() << " to " << to.transpose();
      ++crossed;
      ASSERT_NEAR(entry, expected, 1.0F / 1999);
      const Vec3f at = from + entry * (to - from);
      Vec3f outward;
      ASSERT_NEAR(solid->distance(at, outward), 0, 1e-5F);
      // A step back from the entry is in the fluid along the normal, and the way leads against it.
      ASSERT_NEAR(solid->distance(at + 0.01F * normal, outward), 0.01F, 1e-5F);
      ASSERT_LT(normal.dot(to - from), 0);
    }
    EXPECT_GT(crossed, 200);
    EXPECT_GT(passed, 200);
    EXPECT_LT(grazed, 4);
  }
}

TEST(ThinWall, WaysThatEndAtOrSlideAlongTheSolidDoNotCross) {
  const Box plate({0, 0, 0}, {1, 0.1, 1}, Box::Fluid::outside);
  Vec3f normal;
  float entry = 0;
  EXPECT_FALSE(plate.crosses({0.2F, 0.1F, 0.2F}, {0.8F, 0.1F, 0.9F}, normal, entry)) << "along the face";
  EXPECT_FALSE(plate.crosses({0.2F, 0.2F, 0.2F}, {0.4F, 0.1F, 0.3F}, normal, entry)) << "up to the face";
  EXPECT_FALSE(plate.crosses({0.4F, 0.1F, 0.3F}, {0.2F, 0.2F, 0.2F}, normal, entry)) << "away from the face";
  EXPECT_FALSE(plate.crosses({0.4F, 0.2F, 0.3F}, {0.4F, 0.2F, 0.3F}, normal, entry)) << "no way at all";
  ASSERT_TRUE(plate.crosses({0.4F, 0.2F, 0.3F}, {0.4F, -0.2F, 0.3F}, normal, entry));
  EXPECT_FLOAT_EQ(entry, 0.25F);
  EXPECT_TRUE(normal.isApprox(Vec3f::UnitY()));
}

}  // namespace thin_wall_test
}  // namespace migiwa
