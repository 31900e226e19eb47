// Distances and projections of the shapes against closed forms and brute force.
#include "core/walls/shapes.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace migiwa {
namespace shapes_test {

const Rotation kTurn{{1, 2, -0.5}, 37};

std::vector<Vec3f> randomPoints(int count, double reach, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(static_cast<float>(-reach), static_cast<float>(reach));
  std::vector<Vec3f> points;
  for (int k = 0; k < count; ++k)
    points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  return points;
}

/// Unsigned distance to a box's faces, by clamping to each of the six in turn, in double.
double distanceToFaces(const Vec3d& local, const Vec3d& half) {
  double best = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3d foot = local.cwiseMax(-half).cwiseMin(half);
      foot[axis] = side * half[axis];
      best = std::min(best, (local - foot).norm());
    }
  }
  return best;
}

TEST(Plane, DistanceIsTheDotProductWithTheUnitNormal) {
  const Plane plane({1, 2, 3}, {0, 3, 4});
  Vec3f normal;
  EXPECT_NEAR(plane.distance({7, 2, 3}, normal), 0, 1e-6);
  EXPECT_NEAR(plane.distance({1, 2 + 0.6F, 3 + 0.8F}, normal), 1, 1e-6);
  EXPECT_NEAR(plane.distance({1, 2 - 1.2F, 3 - 1.6F}, normal), -2, 1e-6);
  EXPECT_NEAR((normal - Vec3f(0, 0.6F, 0.8F)).norm(), 0, 1e-6);
}

TEST(Plane, ProjectionMovesAlongTheNormalAndOnlyWhatIsTooNear) {
  const Plane plane({0, 0, 0}, {0, 1, 0});
  Vec3f p(3, -0.5F, 1);
  EXPECT_TRUE(plane.project(p, 0.25F));
  EXPECT_TRUE(p.isApprox(Vec3f(3, 0.25F, 1)));
  EXPECT_FALSE(plane.project(p, 0.25F));
}

TEST(Box, DistanceAgreesWithTheNearestOfSixFaces) {
  const Vec3d half(0.5, 0.3, 0.8), center(0.2, -0.1, 0.4);
  for (const Rotation& rotation : {Rotation{}, kTurn}) {
    for (const Box::Fluid fluid : {Box::Fluid::inside, Box::Fluid::outside}) {
      const Box box(center - half, center + half, fluid, rotation);
      for (const Vec3f& p : randomPoints(500, 1.5, 1)) {
        const Vec3d local = rotation.matrix().transpose() * (p.cast<double>() - center);
        const bool inside = (local.cwiseAbs().array() < half.array()).all();
        const double expected =
            (inside == (fluid == Box::Fluid::inside) ? 1 : -1) * distanceToFaces(local, half);
        Vec3f normal;
        const auto found = static_cast<double>(box.distance(p, normal));
        ASSERT_NEAR(found, expected, 1e-5);
        ASSERT_NEAR(normal.norm(), 1, 1e-5);
        // Walking the distance along the normal ends on the wall.
        const Vec3f foot = p - static_cast<float>(found) * normal;
        Vec3f ignored;
        ASSERT_NEAR(box.distance(foot, ignored), 0, 1e-5);
      }
    }
  }
}

TEST(Box, ProjectionEndsAtTheMarginByTheShortestWay) {
  const float margin = 0.05F;
  for (const Rotation& rotation : {Rotation{}, kTurn}) {
    for (const Box::Fluid fluid : {Box::Fluid::inside, Box::Fluid::outside}) {
      const Box box({-0.5, -0.3, -0.8}, {0.5, 0.3, 0.8}, fluid, rotation);
      for (const Vec3f& p : randomPoints(500, 1.5, 2)) {
        Vec3f normal;
        const float before = box.distance(p, normal);
        Vec3f q = p;
        const bool moved = box.project(q, margin);
        ASSERT_EQ(moved, q != p);
        ASSERT_GE(box.distance(q, normal), margin - 1e-5F);
        if (before >= margin + 1e-5F) {
          ASSERT_FALSE(moved);
        } else if (fluid == Box::Fluid::outside) {
          // From outside near an edge or inside the block, no point at the margin is nearer than this.
          ASSERT_NEAR((q - p).norm(), margin - before, 1e-4F);
        }
      }
    }
  }
}

TEST(Box, WithoutRoomTheProjectionIsMidway) {
  const Box slit({-1, -0.01, -1}, {1, 0.01, 1}, Box::Fluid::inside);
  Vec3f p(0.3F, 0.5F, 0.2F);
  EXPECT_TRUE(slit.project(p, 0.05F));
  EXPECT_TRUE(p.isApprox(Vec3f(0.3F, 0, 0.2F)));
}

TEST(Box, PiecesAreTheFacesInReach) {
  const Box tank({0, 0, 0}, {1, 1, 1}, Box::Fluid::inside);
  std::vector<WallPiece> pieces;
  tank.pieces({0.1F, 0.5F, 0.05F}, 0.2F, pieces);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_TRUE(pieces[0].normal.isApprox(Vec3f(1, 0, 0)));
  EXPECT_NEAR(pieces[0].planeDistance, 0.1F, 1e-6);
  EXPECT_TRUE(pieces[1].normal.isApprox(Vec3f(0, 0, 1)));
  EXPECT_NEAR(pieces[1].planeDistance, 0.05F, 1e-6);
  EXPECT_TRUE(pieces[1].foot.isApprox(Vec3f(0.1F, 0.5F, 0)));

  const Box block({0, 0, 0}, {1, 1, 1}, Box::Fluid::outside);
  pieces.clear();
  block.pieces({1.3F, 1.3F, 0.5F}, 0.2F, pieces);
  EXPECT_TRUE(pieces.empty()) << "the edge is 0.42 away";
}

TEST(Box, BoundsHoldTheTurnedCorners) {
  const Box box({-1, -1, -1}, {1, 1, 1}, Box::Fluid::inside, Rotation{{0, 0, 1}, 45});
  EXPECT_NEAR(box.bounds().max.x(), std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(box.bounds().max.z(), 1, 1e-9);
}

}  // namespace shapes_test
}  // namespace migiwa
