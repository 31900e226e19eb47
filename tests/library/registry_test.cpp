// Shapes and effects from outside the library: scenes name them like the library's own.
#include "core/base/registry.h"

#include <cmath>

#include <gtest/gtest.h>
#include <migiwa/effects.h>
#include <migiwa/gamma.h>
#include <migiwa/scene.h>
#include <migiwa/simulation.h>
#include <migiwa/walls.h>

#include "core/base/messages.h"

namespace migiwa {
namespace registry_test {

/// A ball that knows its distance only.
class Ball final : public Described<Ball, DistanceSurface> {
 public:
  static void fields(auto& visitor, auto& self) {
    visitor.number("radius", self.radius_, Range::length(10), {"m", "Radius.", Presence::required});
  }
  double signedDistance(const Vec3d& p) const override { return p.norm() - radius_; }
  Bounds bounds() const override { return {Vec3d::Constant(-radius_), Vec3d::Constant(radius_)}; }

 private:
  double radius_ = 0.5;
};

/// A round vessel about a point.
class Vessel final : public Described<Vessel, DistanceSurface> {
 public:
  static void fields(auto& visitor, auto& self) { visitor.place("center", self.center_, {"m", "Centre."}); }
  double signedDistance(const Vec3d& p) const override { return kRadius - (p - center_).norm(); }
  Bounds bounds() const override {
    return {center_ - Vec3d::Constant(kRadius), center_ + Vec3d::Constant(kRadius)};
  }
  static constexpr double kRadius = 0.5;

 private:
  Vec3d center_ = Vec3d::Zero();
};

class Push final : public EffectOf<Push> {
 public:
  static void fields(auto& visitor, auto& self) {
    visitor.vector("by", self.by_, {"m/s^2", "Acceleration."});
  }
  EffectStages stages() const override { return {.velocity = true}; }
  void changeVelocities(StepState& state, std::span<EffectBuffer>) const override {
    for (Float4& velocity : state.particles.velocity)
      velocity.setXyz(velocity.xyz() + state.timeStep * by_.cast<float>());
  }

 private:
  Vec3d by_ = Vec3d::Zero();
};

void registerOurs() {
  static const bool once = [] {
    registerSurface<Ball>("ball_of_ours");
    registerSurface<Vessel>("vessel_of_ours");
    registerEffect<Push>("push_of_ours");
    return true;
  }();
  ASSERT_TRUE(once);
}

Scene sceneOf(const std::string& keys) {
  return parseScene(R"({ "format": 1, "particle_spacing": 0.1, "gravity": [0, 0, 0], )" + keys + "}",
                    "ours.json");
}

TEST(OutsideTheLibrary, AnEffectActsAndIsWrittenBack) {
  registerOurs();
  const Scene scene = sceneOf(R"("fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.2, 0.2, 0.2] } ],
      "effects": { "push_of_ours": { "by": [0, 3, 0] } })");
  Simulation simulation(scene, 1);
  while (simulation.frame() < 20) simulation.advanceFrame();
  // v = a t, but for positions that are rounded in every step.
  for (const Float4& velocity : simulation.view().velocities)
    EXPECT_NEAR(velocity.y, 3 * simulation.time(), 1e-3 * 3 * simulation.time());
  const Scene again = parseScene(writeScene(scene), "again.json");
  ASSERT_EQ(again.effects.size(), 1U);
  EXPECT_EQ(again.effects.front().name, "push_of_ours");
  EXPECT_NE(sceneSchema().find("push_of_ours"), std::string::npos);
}

TEST(OutsideTheLibrary, AShapeHoldsWaterOff) {
  registerOurs();
  const Scene scene =
      sceneOf(R"("fluid": [ { "shape": "box", "min": [-0.2, 0.7, -0.2], "max": [0.2, 1.1, 0.2],
      "velocity": [0, -2, 0] } ], "boundary": { "surfaces": [ { "shape": "ball_of_ours", "radius": 0.5 } ] })");
  Simulation simulation(scene, 1);
  float least = 1;
  while (simulation.time() < 0.4) {
    simulation.advanceFrame();
    for (const Float4& p : simulation.view().positions) least = std::min(least, p.xyz().norm());
  }
  // Centres stay half a spacing away from walls.
  EXPECT_GT(least, 0.5F + 0.05F - 0.002F);
  EXPECT_LT(least, 0.56F);
  EXPECT_FALSE(simulation.stopped());
}

TEST(OutsideTheLibrary, AVesselHoldsWaterInAsTheLibrarysDoes) {
  registerOurs();
  // So far from zero that floats would not hold the distances: places are relative to the scene's origin.
  const auto vessel = [](const std::string& shape) {
    return sceneOf(R"("fluid": [ { "shape": "sphere", "center": [1e6, 0, 0], "radius": 0.3,
        "velocity": [0, -2, 0] } ], "boundary": { "surfaces": [ { "center": [1e6, 0, 0], )" +
                   shape + " } ] }");
  };
  const Scene ours = vessel(R"("shape": "vessel_of_ours")");
  const Scene known = vessel(R"("shape": "sphere", "fluid": "inside", "radius": 0.5)");
  const std::vector<Vec3d> points{{1e6, 0, 0}, {1e6, 0.45, 0}, {1e6 + 0.3, 0.3, 0.2}, {1e6, 0, -0.5}};
  const auto found = WallQuery(ours, 1).answers(points), right = WallQuery(known, 1).answers(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_NEAR(found[k].distance, right[k].distance, 1e-6) << k;
    EXPECT_NEAR(found[k].gamma, right[k].gamma, 1e-3) << k;
  }
  Simulation simulation(ours, 1);
  while (simulation.time() < 0.3) simulation.advanceFrame();
  const Vec3d middle = Vec3d(1e6, 0, 0) - ours.origin;
  double farthest = 0;
  for (const Float4& p : simulation.view().positions)
    farthest = std::max(farthest, (p.xyz().cast<double>() - middle).norm());
  EXPECT_NEAR(farthest, 0.5 - 0.05, 1e-3);
}

TEST(OutsideTheLibrary, RaysGoAheadByDistances) {
  registerOurs();
  const Scene scene = sceneOf(R"("boundary": { "surfaces": [ { "shape": "ball_of_ours", "radius": 0.5 },
      { "shape": "sphere", "fluid": "outside", "center": [0, 0, 0], "radius": 0.5 } ] })");
  const Directions directions = fibonacciDirections(500);
  const Vec3f origin(0.55F, 0.1F, -0.05F);
  std::vector<float> found(directions.size(), 2), known(directions.size(), 2);
  scene.surfaces[0]->firstHits(origin, directions, found);
  scene.surfaces[1]->firstHits(origin, directions, known);
  for (std::size_t k = 0; k < found.size(); ++k) {
    // A ray that grazes the ball is near it for long: there either answer will do.
    const Vec3f direction(directions.x[k], directions.y[k], directions.z[k]);
    const float nearest = (origin - origin.dot(direction) * direction).norm();
    if (std::abs(nearest - 0.5F) < 1e-3F) continue;
    EXPECT_NEAR(found[k], known[k], 1e-3F) << k;
  }
}

TEST(OutsideTheLibrary, NormalsFollowFromDistances) {
  const Ball ball;
  for (const Vec3f& p : {Vec3f(0.5F, 0.1F, -0.2F), Vec3f(-3, 20, 7), Vec3f(0.01F, 0, -0.02F)}) {
    Vec3f normal;
    EXPECT_FLOAT_EQ(ball.distance(p, normal), static_cast<float>(p.cast<double>().norm() - 0.5));
    EXPECT_NEAR((normal - p.normalized()).norm(), 0, 1e-6F);
  }
  // Where the distance has no gradient any unit vector will do.
  Vec3f normal;
  EXPECT_EQ(ball.distance(Vec3f::Zero(), normal), -0.5F);
  EXPECT_FLOAT_EQ(normal.norm(), 1);
}

TEST(OutsideTheLibrary, NamesAreNewWords) {
  registerOurs();
  EXPECT_THROW(registerSurface<Ball>("box"), std::invalid_argument);
  EXPECT_THROW(registerSurface<Ball>("ball_of_ours"), std::invalid_argument);
  EXPECT_THROW(registerSurface<Ball>("A Ball"), std::invalid_argument);
  EXPECT_THROW(registerSurface<Ball>(""), std::invalid_argument);
  EXPECT_THROW(registerSurface("nothing", {}), std::invalid_argument);
  EXPECT_THROW(registerEffect<Push>("viscosity"), std::invalid_argument);
}

TEST(OutsideTheLibrary, NamesStayWhereTheyAre) {
  Registry<Effect> registry("an effect", {{"first", [] { return std::make_unique<Push>(); }}});
  const std::span<const std::string_view> before = registry.names();
  for (int k = 0; k < 63; ++k)
    registry.add("more" + std::to_string(k), [] { return std::make_unique<Push>(); });
  EXPECT_EQ(before.size(), 1U);
  EXPECT_EQ(before.data(), registry.names().data());
  EXPECT_EQ(before.front(), "first");
  EXPECT_EQ(registry.names().size(), 64U);
  EXPECT_EQ(registry.names().back(), "more62");
  EXPECT_THROW(registry.add("one_too_many", [] { return std::make_unique<Push>(); }), std::invalid_argument);
}

}  // namespace registry_test
}  // namespace migiwa
