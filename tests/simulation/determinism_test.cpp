// The same binary gives the same bits for any number of threads, run after run.
#include <gtest/gtest.h>

#include "core/simulation/simulation.h"
#include "tests/support/test_scenes.h"

namespace migiwa {
namespace determinism_test {

using namespace migiwa::testing;

std::uint64_t hashAfter(const Scene& scene, int threads, int frames) {
  Simulation simulation(scene, threads);
  for (int k = 0; k < frames; ++k) simulation.advanceFrame();
  return simulation.stateHash();
}

TEST(Determinism, TheHashIsTheSameForAnyNumberOfThreads) {
  Scene scene = emptyScene();
  scene.gravity = {0, -9.81, 0};
  addFluid(scene, Vec3d::Zero(), {0.5, 0.6, 0.5});  // 1,200 particles: several chunks
  addTank(scene, Vec3d::Zero(), {1, 1, 0.5});
  addViscosity(scene);
  const std::uint64_t one = hashAfter(scene, 1, 40);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(hashAfter(scene, threads, 40), one) << threads;
  EXPECT_EQ(hashAfter(scene, 1, 40), one) << "the second run";
  EXPECT_NE(hashAfter(scene, 1, 41), one);
}

TEST(Determinism, LookingAtARunDoesNotChangeIt) {
  const Scene scene = smallDamBreak();
  Simulation watched(scene, 1);
  FrameSnapshot snapshot;
  for (int k = 0; k < 20; ++k) {
    watched.advanceFrame();
    snapshot.assign(watched.view());
    watched.walls();
  }
  EXPECT_EQ(watched.stateHash(), hashAfter(scene, 1, 20));
  EXPECT_EQ(snapshot.info.stateHash, watched.stateHash());
}

}  // namespace determinism_test
}  // namespace migiwa
