// Walls as bodies: where rays enter and leave them, against distances that the walls themselves have.
#include "app/raytrace/bodies.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/slim/points.h"
#include "core/walls/shapes.h"

namespace migiwa {
namespace bodies_test {

Vec3f anyPoint(RandomSequence& random, double size) {
  const auto one = [&] { return static_cast<float>(size * (2 * random.unit() - 1)); };
  const float x = one(), y = one(), z = one();
  return {x, y, z};
}

/// Rays to a body meet its surface where the wall's distance is 0, with the normal into the fluid, and leave
/// it where it is 0 again; between these it is a solid's.
void expectSurface(const Surface& wall, const Body& body, int least) {
  RandomSequence random(11);
  int met = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3f origin = anyPoint(random, 2), target = anyPoint(random, 0.5);
    const Vec3f direction = (target - origin).normalized();
    Vec3f normal;
    if (wall.distance(origin, normal) < 0.01F) continue;
    BodyHit in;
    if (!body.enter(origin, direction, in)) continue;
    ++met;
    const Vec3f entry = origin + in.distance * direction;
    EXPECT_NEAR(wall.distance(entry, normal), 0, 1e-5);
    EXPECT_GT(normal.dot(in.normal), 0.999F);
    EXPECT_LT(direction.dot(in.normal), 0);
    BodyHit out;
    ASSERT_TRUE(body.leave(entry, direction, out));
    const Vec3f exit = entry + out.distance * direction;
    EXPECT_NEAR(wall.distance(exit, normal), 0, 1e-5);
    EXPECT_GT(direction.dot(out.normal), -1e-5F);
    const Vec3f middle = 0.5F * (entry + exit);
    if (out.distance > 1e-3F) {
      EXPECT_TRUE(body.contains(middle));
    }
    EXPECT_FALSE(body.contains(origin));
  }
  EXPECT_GT(met, least);
}

TEST(Bodies, BallsAndBlocksAreWhereTheirWallsAre) {
  const Sphere ball({0.1, 0.2, -0.1}, 0.4, Sphere::Fluid::outside);
  expectSurface(ball, *Body::around(ball, true, 0.05F, Vec3f::UnitY()), 1000);
  const Box block({-0.4, -0.3, -0.2}, {0.3, 0.5, 0.4}, Box::Fluid::outside, {Vec3d(1, 2, 3), 40});
  expectSurface(block, *Body::around(block, true, 0.05F, Vec3f::UnitY()), 1000);
}

TEST(Bodies, AGlassTankIsAShellThatIsOpenAbove) {
  const Box tank({0, 0, 0}, {1, 1, 1}, Box::Fluid::inside);
  const Body body = *Body::around(tank, true, 0.1F, Vec3f::UnitY());
  BodyHit hit;
  ASSERT_TRUE(body.enter({-1, 0.5F, 0.5F}, Vec3f::UnitX(), hit));
  EXPECT_NEAR(hit.distance, 0.9, 1e-6);
  BodyHit out;
  ASSERT_TRUE(body.leave({-0.1F, 0.5F, 0.5F}, Vec3f::UnitX(), out));
  EXPECT_NEAR(out.distance, 0.1, 1e-6);
  EXPECT_NEAR(out.normal.x(), 1, 1e-6);
  hit = {};
  ASSERT_TRUE(body.enter({0, 0.5F, 0.5F}, Vec3f::UnitX(), hit)) << "from within to the far side";
  EXPECT_NEAR(hit.distance, 1, 1e-6);
  EXPECT_NEAR(hit.normal.x(), -1, 1e-6);
  hit = {};
  EXPECT_FALSE(body.enter({0.5F, 0.5F, 0.5F}, Vec3f::UnitY(), hit)) << "it has no lid";
  ASSERT_TRUE(body.enter({0.5F, 3, 0.5F}, -Vec3f::UnitY(), hit));
  EXPECT_NEAR(hit.distance, 3, 1e-6) << "its floor";
  hit = {};
  ASSERT_TRUE(body.enter({-0.05F, 3, 0.5F}, -Vec3f::UnitY(), hit));
  EXPECT_NEAR(hit.distance, 1.9, 1e-6) << "the rim of a side";
  EXPECT_FALSE(body.contains({0.5F, 1.05F, 0.5F}));
  EXPECT_TRUE(body.contains({-0.05F, 0.5F, 0.5F}));
}

TEST(Bodies, AMattTankIsSeenFromWithinOnly) {
  const Box tank({0, 0, 0}, {1, 1, 1}, Box::Fluid::inside);
  const Body body = *Body::around(tank, false, 0.1F, Vec3f::UnitY());
  BodyHit hit;
  ASSERT_TRUE(body.enter({-1, 0.5F, 0.5F}, Vec3f::UnitX(), hit));
  EXPECT_NEAR(hit.distance, 2, 1e-6) << "its far side";
}

TEST(Bodies, MeshesHaveAnInsideOrAShell) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  // A ball that is known by its triangles alone.
  class MeshBall final : public Surface {
   public:
    explicit MeshBall(bool vessel)
        : ball_(Vec3d::Zero(), 1, vessel ? Sphere::Fluid::inside : Sphere::Fluid::outside), vessel_(vessel) {}
    void describe(FieldVisitor&) override {}
    void describe(FieldWriter&) const override {}
    float distance(const Vec3f& p, Vec3f& normal) const override { return ball_.distance(p, normal); }
    bool project(Vec3f& p, float margin) const override { return ball_.project(p, margin); }
    void firstHits(const Vec3f& o, const Directions& d, std::span<float> h) const override {
      ball_.firstHits(o, d, h);
    }
    Bounds bounds() const override { return ball_.bounds(); }
    void wireframe(const Bounds&, std::vector<LineSegment>&) const override {}
    WallMesh mesh() const override {
      WallMesh mesh;
      mesh.vessel = vessel_;
      ball_.enclosed(mesh.surface);
      for (const Vec3f& p : mesh.surface.vertices)
        mesh.normals.emplace_back((vessel_ ? -1.0F : 1.0F) * p.normalized());
      if (vessel_)
        for (auto& corners : mesh.surface.triangles) std::swap(corners[1], corners[2]);
      return mesh;
    }

   private:
    Sphere ball_;
    bool vessel_;
  };
  const MeshBall solid(false), vessel(true);
  const Body ball = *Body::around(solid, true, 0.1F, Vec3f::UnitY());
  const Body shell = *Body::around(vessel, true, 0.1F, Vec3f::UnitY());
  EXPECT_TRUE(ball.meshed());
  BodyHit hit;
  ASSERT_TRUE(ball.enter({-3, 0.1F, 0.2F}, Vec3f::UnitX(), hit));
  EXPECT_NEAR(hit.distance, 3 - std::sqrt(0.95), 1e-3);
  EXPECT_LT((hit.shading - Vec3f(-3 + hit.distance, 0.1F, 0.2F)).norm(), 2e-3F);
  ASSERT_TRUE(ball.leave(Vec3f(0, 0.1F, 0.2F), Vec3f::UnitX(), hit));
  EXPECT_NEAR(hit.distance, std::sqrt(0.95), 1e-3);
  hit = {};
  ASSERT_TRUE(shell.enter({-3, 0.1F, 0.2F}, Vec3f::UnitX(), hit));
  EXPECT_NEAR(hit.distance, 3 - std::sqrt(1.21 - 0.05), 1e-3);
  ASSERT_TRUE(shell.leave({-1.05F, 0.1F, 0.2F}, Vec3f::UnitX(), hit));
  EXPECT_NEAR(hit.distance, 1.05 - std::sqrt(0.95), 1e-3);
  EXPECT_TRUE(shell.contains({-1.05F, 0, 0}));
  EXPECT_FALSE(shell.contains({0, 0, 0}));
  EXPECT_FALSE(shell.contains({1.2F, 0, 0}));
}

TEST(TriangleRays, WithoutTrianglesNothingIsHit) {
  const TriangleRays rays{TriangleMesh{}};
  TriangleRays::Hit hit;
  EXPECT_FALSE(rays.first({0, 0, 0}, Vec3f::UnitX(), 0, 1, hit));
  EXPECT_FALSE(rays.any({0, 0, 0}, Vec3f::UnitX(), 0, 1));
}

TEST(TriangleRays, WithoutEmbreeTheySayWhatToInstall) {
  if (raysAvailable()) GTEST_SKIP() << "this program has Embree";
  EXPECT_THROW(TriangleRays(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), MissingError);
}

}  // namespace bodies_test
}  // namespace migiwa
