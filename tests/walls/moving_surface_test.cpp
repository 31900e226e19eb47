// A wall that moves is, at every moment, the wall that stands there.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/walls/boundary.h"
#include "core/walls/shapes.h"

namespace migiwa {
namespace moving_surface_test {

Motion turning() {
  Motion motion;
  motion.velocity = {0.3, -0.2, 0.1};
  motion.turns = true;
  motion.axis = {0, 0, 2};
  motion.point = {0.5, 0.5, 0.5};
  motion.degreesPerSecond = 60;
  return motion;
}

std::shared_ptr<Box> block(const Motion& motion) {
  auto box = std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(1, 1, 1), Box::Fluid::outside);
  box->motion = motion;
  return box;
}

std::vector<Vec3f> points() {
  std::vector<Vec3f> result;
  for (int k = 0; k < 200; ++k) {
    const auto part = [k](double by) { return static_cast<float>(3 * std::fmod(k * by, 1.0) - 1); };
    result.emplace_back(part(0.618034), part(0.754878), part(0.569840));
  }
  return result;
}

TEST(MovingSurface, IsTheBoxThatStandsWhereItIs) {
  Boundary boundary({block(turning())});
  boundary.moveTo(0.49, 0.5);
  // After half a second: turned by 30 degrees about its centre and carried along.
  const Vec3d carried = 0.5 * Vec3d(0.3, -0.2, 0.1);
  const Box there(carried, Vec3d(1, 1, 1) + carried, Box::Fluid::outside, {Vec3d::UnitZ(), 30});
  const Surface& moving = *boundary.surfaces().front();
  const Directions directions = fibonacciDirections(64);
  for (const Vec3f& p : points()) {
    Vec3f normal, expected;
    const float distance = there.distance(p, expected);
    EXPECT_NEAR(moving.distance(p, normal), distance, 2e-6F);
    if (distance > 0) {
      EXPECT_LT((normal - expected).norm(), 1e-3F);
    }
    Vec3f projected = p, projectedThere = p;
    EXPECT_EQ(moving.project(projected, 0.1F), there.project(projectedThere, 0.1F));
    if (distance > 0) {
      EXPECT_LT((projected - projectedThere).norm(), 2e-6F);
    }
    if (distance <= 0.01F) continue;
    std::vector<float> hits(64, 5), hitsThere(64, 5), exits(64), exitsThere(64);
    moving.firstHits(p, directions, hits), there.firstHits(p, directions, hitsThere);
    moving.exits(p, directions, exits), there.exits(p, directions, exitsThere);
    for (std::size_t k = 0; k < 64; ++k) {
      if (hitsThere[k] == 5 || std::abs(exitsThere[k] - hitsThere[k]) < 0.01F) continue;  // grazes an edge
      EXPECT_NEAR(hits[k], hitsThere[k], 1e-4F);
      EXPECT_NEAR(exits[k], exitsThere[k], 1e-4F);
    }
    std::vector<WallPiece> pieces, piecesThere;
    moving.pieces(p, 0.7F, pieces), there.pieces(p, 0.7F, piecesThere);
    ASSERT_EQ(pieces.size(), piecesThere.size());
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      EXPECT_LT((pieces[k].normal - piecesThere[k].normal).norm(), 1e-5F);
      EXPECT_LT((pieces[k].foot - piecesThere[k].foot).norm(), 5e-6F);
      EXPECT_NEAR(pieces[k].planeDistance, piecesThere[k].planeDistance, 5e-6F);
    }
  }
  EXPECT_LT((moving.bounds().min - there.bounds().min).norm(), 1e-9);
}

TEST(MovingSurface, VelocityIsThatOfARigidBody) {
  Boundary boundary({block(turning())});
  const double before = 0.4999, now = 0.5;
  boundary.moveTo(before, now);
  // v + w x r about the axis where it is, at the middle of the step.
  const double rate = std::numbers::pi / 3;
  for (const Vec3f& p : points()) {
    const Vec3d r = p.cast<double>() - (Vec3d(0.5, 0.5, 0.5) + now * Vec3d(0.3, -0.2, 0.1));
    const Vec3d expected = Vec3d(0.3, -0.2, 0.1) + rate * Vec3d::UnitZ().cross(r);
    EXPECT_LT((boundary.wallVelocity(p).cast<double>() - expected).norm(), 3e-4);
  }
}

TEST(MovingSurface, CarriedPointsKeepTheirPlaceOnTheWall) {
  Boundary before({block(turning())}), now({block(turning())});
  before.moveTo(0.2, 0.2);
  now.moveTo(0.2, 0.21);
  for (const Vec3f& p : points())
    EXPECT_NEAR(before.distance(p), now.distance(now.surfaces().front()->carried(p)), 2e-6F);
}

TEST(MovingSurface, TheNearestWallLendsItsVelocity) {
  auto still = std::make_shared<Plane>(Vec3d(0, -1, 0), Vec3d(0, 1, 0));
  Motion up;
  up.velocity = {0, 2, 0};
  auto ball = std::make_shared<Sphere>(Vec3d(0, 1, 0), 0.5, Sphere::Fluid::outside);
  ball->motion = up;
  Boundary boundary({still, ball});
  boundary.moveTo(0, 0.01);
  EXPECT_EQ(boundary.wallVelocity({0, -0.9F, 0}), Vec3f(0, 0, 0));
  EXPECT_LT((boundary.wallVelocity({0, 0.4F, 0}) - Vec3f(0, 2, 0)).norm(), 1e-5F);
}

TEST(MovingSurface, SweptBoundsHoldEveryPlace) {
  const auto box = block(turning());
  const Bounds swept = sweptBounds(*box, 3);
  Boundary boundary({box});
  for (int k = 0; k <= 30; ++k) {
    boundary.moveTo(0.1 * k, 0.1 * k);
    const Bounds here = boundary.surfaces().front()->bounds();
    EXPECT_TRUE(swept.grown(1e-3).contains(here.min) && swept.grown(1e-3).contains(here.max));
  }
}

TEST(Motion, OscillationIsASine) {
  Motion motion;
  motion.oscillates = true;
  motion.amplitude = {0.2, 0, 0};
  motion.period = 4;
  motion.start = 1;
  EXPECT_EQ(motion.at(0.5).translation().norm(), 0);
  EXPECT_NEAR(motion.at(2).translation().x(), 0.2, 1e-12);
  EXPECT_NEAR(motion.at(4).translation().x(), -0.2, 1e-12);
  // The largest speed of a sine is 2 pi A / T.
  Bounds bounds;
  bounds.include(Vec3d(0, 0, 0));
  EXPECT_NEAR(largestSpeed(motion, bounds, 1, 1.01), 2 * std::numbers::pi * 0.2 / 4, 1e-4);
}

TEST(Motion, KeyframesAreMetAndSmoothOnesAreAtRestThere) {
  Motion motion;
  motion.keyframes = {{1, Vec3d::Zero(), 0}, {3, {0, 1, 0}, 0}};
  const auto height = [&](double time) { return motion.at(time).translation().y(); };
  EXPECT_EQ(height(0), 0);
  EXPECT_EQ(height(3), 1);
  EXPECT_EQ(height(9), 1);
  EXPECT_NEAR(height(2), 0.5, 1e-12);
  EXPECT_NEAR(height(1.001), 0, 1e-6);
  EXPECT_NEAR(height(1.5), 0.15625, 1e-12);  // 3/16 - 2/64
  motion.interpolation = Interpolation::linear;
  EXPECT_NEAR(height(1.5), 0.25, 1e-12);
}

}  // namespace moving_surface_test
}  // namespace migiwa
