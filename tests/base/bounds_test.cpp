#include <gtest/gtest.h>

#include "core/base/math.h"

namespace migiwa {
namespace bounds_test {

TEST(Bounds, AreEmptyUntilSomethingIsIncluded) {
  Bounds bounds;
  EXPECT_TRUE(bounds.empty());
  EXPECT_EQ(bounds.size(), Vec3d::Zero());
  EXPECT_FALSE(bounds.contains(Vec3d::Zero()));
  bounds.include(Vec3d(1, 2, 3));
  EXPECT_FALSE(bounds.empty());
  EXPECT_EQ(bounds.size(), Vec3d::Zero());
  EXPECT_TRUE(bounds.contains(Vec3d(1, 2, 3)));
}

TEST(Bounds, GrowToHoldEveryPoint) {
  Bounds bounds;
  bounds.include(Vec3d(1, -2, 3));
  bounds.include(Vec3d(-1, 4, 2));
  EXPECT_EQ(bounds.min, Vec3d(-1, -2, 2));
  EXPECT_EQ(bounds.max, Vec3d(1, 4, 3));
  EXPECT_EQ(bounds.center(), Vec3d(0, 1, 2.5));
  EXPECT_EQ(bounds.size(), Vec3d(2, 6, 1));
}

TEST(Bounds, ContainTheirOwnFacesAndNothingBeyond) {
  Bounds bounds{Vec3d(0, 0, 0), Vec3d(1, 2, 3)};
  EXPECT_TRUE(bounds.contains(Vec3d(0, 0, 0)));
  EXPECT_TRUE(bounds.contains(Vec3d(1, 2, 3)));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_FALSE(bounds.contains(bounds.max + 1e-9 * Vec3d::Unit(axis))) << axis;
    EXPECT_FALSE(bounds.contains(bounds.min - 1e-9 * Vec3d::Unit(axis))) << axis;
  }
}

TEST(Bounds, IncludingEmptyBoundsChangesNothing) {
  Bounds bounds{Vec3d(0, 0, 0), Vec3d(1, 2, 3)};
  bounds.include(Bounds{});
  EXPECT_EQ(bounds.min, Vec3d(0, 0, 0));
  EXPECT_EQ(bounds.max, Vec3d(1, 2, 3));
  bounds.include(Bounds{Vec3d(-1, 1, 1), Vec3d(0.5, 5, 2)});
  EXPECT_EQ(bounds.min, Vec3d(-1, 0, 0));
  EXPECT_EQ(bounds.max, Vec3d(1, 5, 3));
}

TEST(Bounds, GrownMovesEveryFaceOutwards) {
  const Bounds grown = Bounds{Vec3d(0, 0, 0), Vec3d(1, 2, 3)}.grown(0.5);
  EXPECT_EQ(grown.min, Vec3d(-0.5, -0.5, -0.5));
  EXPECT_EQ(grown.max, Vec3d(1.5, 2.5, 3.5));
  EXPECT_TRUE(Bounds{}.grown(1).empty());
}

}  // namespace bounds_test
}  // namespace migiwa
