// Walls are not asked where a particle is known to be clear of them. That must change nothing: a run that
// forgets every clearance between frames, as a save does, goes the same way; and no wall's distance may
// change faster than is reckoned with.
#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "core/simulation/state.h"
#include "core/solver/state.h"
#include "core/walls/gridded.h"
#include "core/walls/shapes.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace clearance_test {

using namespace migiwa::testing;

/// The box as a run has walls whose distance is costly.
std::shared_ptr<const Surface> fromGrid(const Vec3d& min, const Vec3d& max, Box::Fluid fluid,
                                        const Rotation& rotation) {
  ThreadPool pool(2);
  return std::make_shared<GriddedSurface>(std::make_shared<Box>(min, max, fluid, rotation),
                                          static_cast<float>(emptyScene().supportRadius()), pool);
}

std::shared_ptr<const Surface> bowl() {
  return std::make_shared<Polynomial>(Vec3d(0.4, 0, 0.4), Vec3d::UnitY(), Vec3d::UnitX(), 0.6,
                                      std::vector<Polynomial::Term>{{2, 0, 1.2}, {0, 2, 0.8}});
}

Scene fallingInto(std::vector<std::shared_ptr<const Surface>> walls) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, {0.2, 0.35, 0.2}, {0.6, 0.75, 0.6}, {0.8, -2, 0.3});
  scene.surfaces = std::move(walls);
  addViscosity(scene);
  return scene;
}

struct Case {
  const char* name;
  Scene scene;
};
std::vector<Case> cases() {
  const auto tank =
      std::make_shared<Box>(Vec3d(0, 0, 0), Vec3d(0.8, 0.9, 0.8), Box::Fluid::inside, Rotation{});
  const Rotation turned{{1, 2, 3}, 40};
  std::vector<Case> all;
  all.push_back({"tank", fallingInto({tank})});
  all.push_back({"bowl", fallingInto({bowl()})});
  all.push_back({"block from a grid", fallingInto({tank, fromGrid(Vec3d(0.3, 0.1, 0.3), Vec3d(0.5, 0.25, 0.5),
                                                                  Box::Fluid::outside, turned)})});
  all.push_back({"tank from a grid", fallingInto({fromGrid(Vec3d(0, 0, 0), Vec3d(0.8, 0.9, 0.8),
                                                           Box::Fluid::inside, Rotation{{0, 1, 0}, 10})})});
  all.push_back(
      {"thin plate", fallingInto({tank, std::make_shared<Box>(Vec3d(0.3, 0.2, 0), Vec3d(0.32, 0.5, 0.8),
                                                              Box::Fluid::outside, Rotation{})})});
  return all;
}

TEST(Clearance, ForgettingItChangesNothing) {
  for (const Case& the : cases()) {
    Simulation straight(the.scene, 2), forgetful(the.scene, 2);
    for (int frame = 0; frame < 60; ++frame) {
      straight.advanceFrame();
      StateImage::of(forgetful).restore(forgetful);
      forgetful.advanceFrame();
      ASSERT_EQ(straight.stateHash(), forgetful.stateHash()) << the.name << ", frame " << frame;
    }
    EXPECT_FALSE(straight.statistics().failed()) << the.name;
  }
}

TEST(Clearance, NoDistanceChangesFasterThanReckonedWith) {
  int steady = 0;
  for (const Case& the : cases()) {
    ThreadPool pool(2);
    const auto support = static_cast<float>(the.scene.supportRadius());
    const Boundary walls(withDistanceGrids(the.scene.surfaces, support, pool));
    if (!walls.steady()) continue;
    ++steady;
    float steepest = 0;
    for (int k = 0; k < 200000; ++k) {
      // Steps of 0.02 to 1 support radius from all over the scene; irrational strides fill it evenly.
      const auto draw = [&](double stride) { return static_cast<float>(std::fmod(stride * (k + 1), 1.0)); };
      const Vec3f from(0.8F * draw(0.8191725134), 0.9F * draw(0.6710436067), 0.8F * draw(0.5497004779));
      const Vec3f way(draw(0.8566748838) - 0.5F, draw(0.7338918566) - 0.5F, draw(0.6287067210) - 0.5F);
      const Vec3f to = from + support * (0.02F + 0.98F * draw(0.3819660113)) * way.normalized();
      const float start = walls.distance(from), end = walls.distance(to);
      // In the fluid, and nearer than what grids tell at most.
      if (start <= 0 || start >= GriddedSurface::kReach * support) continue;
      steepest = std::max(steepest, (start - end) / (to - from).norm());
    }
    EXPECT_GT(steepest, 0.99F) << the.name;
    EXPECT_LT(steepest, kSteepestDistance) << the.name;
  }
  EXPECT_EQ(steady, 4) << "all but the bowl, which ends at the rim of its ball";
}

}  // namespace clearance_test
}  // namespace migiwa
