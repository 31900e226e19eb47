// Several walls together.
#include "core/walls/boundary.h"

#include <random>

#include <gtest/gtest.h>

#include "core/walls/shapes.h"

namespace migiwa {
namespace {

TEST(Boundary, WithoutWallsNothingIsNear) {
  const Boundary boundary;
  Vec3f p(1, 2, 3);
  EXPECT_TRUE(std::isinf(boundary.distance(p)));
  EXPECT_FALSE(boundary.project(p, 1));
}

TEST(Boundary, DistanceIsThatOfTheNearestWall) {
  const Boundary boundary({std::make_shared<Plane>(Vec3d(0, 0, 0), Vec3d(0, 1, 0)),
                           std::make_shared<Plane>(Vec3d(0, 0, 0), Vec3d(1, 0, 0))});
  Vec3f normal;
  EXPECT_NEAR(boundary.distance({0.3F, 0.2F, 0}, normal), 0.2F, 1e-6);
  EXPECT_TRUE(normal.isApprox(Vec3f(0, 1, 0)));
}

TEST(Boundary, ProjectionSatisfiesAllWallsOfAWedgeAndATankWithABlock) {
  const Boundary wedge({std::make_shared<Plane>(Vec3d(0, 0, 0), Vec3d(0, 1, 0)),
                        std::make_shared<Plane>(Vec3d(0, 0, 0), Vec3d(0.8, -0.6, 0))});
  const Boundary tank(
      {std::make_shared<Box>(Vec3d(-1, -1, -1), Vec3d(1, 1, 1), Box::Fluid::inside),
       std::make_shared<Box>(Vec3d(-0.2, -1, -0.2), Vec3d(0.2, 0, 0.2), Box::Fluid::outside)});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-1.2F, 1.2F);
  for (int k = 0; k < 300; ++k) {
    const Vec3f start(coordinate(random), coordinate(random), coordinate(random));
    for (const Boundary* boundary : {&wedge, &tank}) {
      Vec3f p = start;
      boundary->project(p, 0.05F);
      ASSERT_GE(boundary->distance(p), 0.049F) << start.transpose();
    }
  }
}

TEST(Boundary, BetweenTwoWallsWithoutRoomTheProjectionIsMidway) {
  const Boundary gap({std::make_shared<Plane>(Vec3d(0, 0, 0), Vec3d(0, 1, 0)),
                      std::make_shared<Plane>(Vec3d(0, 0.04, 0), Vec3d(0, -1, 0))});
  Vec3f p(0.5F, 0.1F, 0);
  EXPECT_TRUE(gap.project(p, 0.05F));
  EXPECT_NEAR(p.y(), 0.02F, 1e-5F);
}

}  // namespace
}  // namespace migiwa
