// Several walls together.
#include "core/walls/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/walls/shapes.h"

namespace migiwa {
namespace boundary_test {

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

TEST(Boundary, AnUprightVesselHoldsWhatIsAMarginAwayFromEachFace) {
  const Vec3d low(-0.3, 0.1, 2), high(0.5, 0.7, 2.06);
  const Boundary tank({std::make_shared<Box>(low, high, Box::Fluid::inside)});
  const Boundary turned({std::make_shared<Box>(low, high, Box::Fluid::inside, Rotation{{0, 1, 0}, 20})});
  const Boundary two({std::make_shared<Box>(low, high, Box::Fluid::inside),
                      std::make_shared<Plane>(Vec3d::Zero(), Vec3d(0, 1, 0))});
  EXPECT_EQ(turned.onlyVessel(), nullptr);
  EXPECT_EQ(two.onlyVessel(), nullptr);
  ASSERT_NE(tank.onlyVessel(), nullptr);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-0.1, 1.1);
  int held = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3d at = low + Vec3d(unit(random), unit(random), unit(random)).cwiseProduct(high - low);
    const Vec3f p = at.cast<float>();
    const double room = std::min((at - low).minCoeff(), (high - at).minCoeff()),
                 margin = k % 3 == 0 ? 0.01 : 0.02;
    if (std::abs(room - margin) < 1e-6) continue;
    held += room > margin ? 1 : 0;
    ASSERT_EQ(tank.onlyVessel()->holds(p, static_cast<float>(margin)), room > margin) << at.transpose();
    Vec3f moved = p;
    ASSERT_EQ(tank.project(moved, static_cast<float>(margin)), room < margin) << at.transpose();
    if (room > 0) {
      ASSERT_NEAR(tank.onlyVessel()->distance(p), room, 1e-6);
    }
  }
  EXPECT_GT(held, 100);
  // Where there is no room, midway alone.
  EXPECT_TRUE(tank.onlyVessel()->holds({0, 0.4F, 2.03F}, 0.031F));
  EXPECT_FALSE(tank.onlyVessel()->holds({0, 0.4F, 2.04F}, 0.031F));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(tank.onlyVessel()->holds({0, nan, 2.03F}, 0.01F));
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

}  // namespace boundary_test
}  // namespace migiwa
