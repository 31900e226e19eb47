// Walls near a place, against asking all of them.
#include "core/walls/wall_index.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "core/walls/boundary.h"
#include "core/walls/shapes.h"

namespace migiwa {
namespace wall_index_test {

/// Boxes and balls anywhere in a tank, some of them thin, one that moves, and a plane.
std::vector<std::shared_ptr<const Surface>> manyWalls(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0, 4), size(0.02, 0.3);
  std::vector<std::shared_ptr<const Surface>> walls{
      std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(4, 4, 4), Box::Fluid::inside),
      std::make_shared<Plane>(Vec3d(0, 0.1, 0), Vec3d(0.1, 1, 0))};
  for (int k = 0; k < count; ++k) {
    const Vec3d middle(place(random), place(random), place(random));
    if (k % 4 == 0) {
      walls.push_back(std::make_shared<Sphere>(middle, size(random), Sphere::Fluid::outside));
    } else {
      const Vec3d half(size(random), size(random), size(random));
      auto box = std::make_shared<Box>(middle - half, middle + half, Box::Fluid::outside,
                                       Rotation{{1, 2, 3}, 50.0 * k});
      if (k == 1) box->motion.emplace().velocity = {1, 0, 0};
      walls.push_back(std::move(box));
    }
  }
  return walls;
}

std::vector<Vec3f> places(int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> coordinate(-1, 5);
  std::vector<Vec3f> result;
  for (int k = 0; k < count; ++k)
    result.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  return result;
}

TEST(WallIndex, BoundariesAnswerAsIfTheyAskedEveryWall) {
  const auto walls = manyWalls(300, 1);
  const Boundary all(walls);
  Boundary indexed(walls);
  indexed.indexWalls(0.2F);
  std::size_t asked = 0, wallsNear = 0;
  for (const Vec3f& p : places(2000)) {
    Vec3f one, other;
    ASSERT_EQ(indexed.distance(p, one), all.distance(p, other)) << p.transpose();
    ASSERT_EQ(one, other);
    // Which walls are asked in a round of projections may differ, where it ends may not.
    Vec3f moved = p, expected = p;
    all.project(expected, 0.05F);
    indexed.project(moved, 0.05F);
    if (all.distance(p) > -0.02F && all.distance(expected) > 0.0499F) {
      ASSERT_GT(all.distance(moved), 0.0499F) << p.transpose();
    }
    // Nothing within reach is missing.
    const auto near = indexed.near(p, 0.2F);
    for (const auto& wall : indexed.surfaces())
      if (wall->distance(p, one) < 0.2F) {
        ASSERT_NE(std::find(near.begin(), near.end(), wall.get()), near.end()) << p.transpose();
      }
    if ((p.array() > 0).all() && (p.array() < 4).all()) {
      ++asked;
      wallsNear += near.size();
    }
  }
  EXPECT_LT(static_cast<double>(wallsNear) / static_cast<double>(asked), 30);
}

TEST(WallIndex, WithoutTheNearestItHasWhatIsInReachOnly) {
  const Boundary walls(manyWalls(300, 2));
  std::vector<const Surface*> pointers;
  for (std::size_t k = 2; k < walls.surfaces().size(); ++k) pointers.push_back(walls.surfaces()[k].get());
  const WallIndex index(pointers, 0.1F, false);
  for (const Vec3f& p : places(2000)) {
    const auto near = index.near(p);
    for (const Surface* wall : pointers) {
      Vec3f ignored;
      if (wall->distance(p, ignored) < 0.1F) {
        ASSERT_NE(std::find(near.begin(), near.end(), wall), near.end());
      }
    }
  }
  // Far away there is the one that moves alone.
  EXPECT_EQ(index.near({50, 50, 50}).size(), 1U);
}

TEST(WallIndex, AWallThatMovesIsFoundWhereItHasGone) {
  const auto walls = manyWalls(300, 1);
  Boundary all(walls), indexed(walls);
  indexed.indexWalls(0.2F);
  all.moveTo(1.4, 1.5);
  indexed.moveTo(1.4, 1.5);
  const Bounds now = all.moving().front()->bounds();
  for (const Vec3f& p : places(2000)) {
    Vec3f one, other;
    ASSERT_EQ(indexed.distance(p, one), all.distance(p, other)) << p.transpose();
  }
  EXPECT_LT(indexed.distance(now.center().cast<float>()), 0);
}

TEST(WallIndex, FewWallsAreAskedOneByOne) {
  const auto walls = manyWalls(3, 1);
  Boundary boundary(walls);
  boundary.indexWalls(0.1F);
  EXPECT_EQ(boundary.near({1, 1, 1}).size(), walls.size());
  EXPECT_EQ(boundary.near({1, 1, 1}, 0.2F).size(), walls.size()) << "beyond the reach that was asked for";
}

}  // namespace wall_index_test
}  // namespace migiwa
