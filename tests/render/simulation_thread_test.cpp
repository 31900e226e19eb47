// The simulation's thread without a window; run it under the thread sanitizer, too.
#include "app/viewer/simulation_thread.h"

#include <functional>

#include <gtest/gtest.h>

#include "tests/render/test_scene.h"

namespace migiwa {
namespace {

/// Takes frames until one satisfies `wanted`; fails after half a minute.
bool waitFor(SimulationThread& simulation, FrameSnapshot& frame, const std::function<bool()>& wanted) {
  for (int i = 0; i < 30000; ++i) {
    simulation.takeFrame(frame);
    if (wanted()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

class SimulationThreadTest : public testing::Test {
 protected:
  Scene scene_ = smallScene();
  SimulationThread simulation_{scene_, 2, Pace::unlimited};
  FrameSnapshot frame_;
};

TEST_F(SimulationThreadTest, ShowsTheStartAndWaits) {
  ASSERT_TRUE(simulation_.takeFrame(frame_));
  EXPECT_EQ(frame_.info.time, 0);
  EXPECT_EQ(frame_.positions.size(), 150U);
  EXPECT_FALSE(simulation_.walls().lines.empty());
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_FALSE(simulation_.takeFrame(frame_)) << "nobody asked it to play";
}

TEST_F(SimulationThreadTest, StepsAreExactlyAsManyAsAskedFor) {
  for (int i = 0; i < 5; ++i) simulation_.step();
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.info.time > 0.0249; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  simulation_.takeFrame(frame_);
  EXPECT_NEAR(frame_.info.time, 0.025, 1e-9);
}

TEST_F(SimulationThreadTest, ComputesWhatASimulationOnThisThreadDoes) {
  Simulation reference(scene_, 1);
  for (int i = 0; i < 20; ++i) reference.advanceFrame();
  for (int i = 0; i < 20; ++i) simulation_.step();
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.info.time > 0.0999; }));
  EXPECT_EQ(frame_.info.stateHash, reference.stateHash());
}

TEST_F(SimulationThreadTest, PlaysAndPauses) {
  simulation_.play();
  EXPECT_TRUE(simulation_.status().playing);
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.info.time > 0.05; }));
  simulation_.pause();
  EXPECT_FALSE(simulation_.status().playing);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  simulation_.takeFrame(frame_);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_FALSE(simulation_.takeFrame(frame_));
}

TEST_F(SimulationThreadTest, SettingsHoldFromTheNextFrameAndAfterAReset) {
  Settings settings{scene_.solver, scene_.boundary, scene_.effects};
  settings.boundary.handling = BoundaryHandling::none;
  simulation_.apply(settings);
  simulation_.step();
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.info.time > 0; }));
  EXPECT_EQ(frame_.info.handling, "no correction");
  simulation_.reset();
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.info.time == 0; }));
  EXPECT_EQ(frame_.info.handling, "no correction");
}

TEST_F(SimulationThreadTest, WishesFromAnotherThreadWhileItPlays) {
  simulation_.play();
  Settings settings{scene_.solver, scene_.boundary, scene_.effects};
  for (int i = 0; i < 200; ++i) {
    settings.solver.maxIterations = 2 + i % 5;
    simulation_.apply(settings);
    if (i % 50 == 10) simulation_.reset();
    if (i % 20 == 5) simulation_.step();
    if (i % 20 == 6) simulation_.play();
    simulation_.takeFrame(frame_);
    EXPECT_EQ(frame_.positions.size(), 150U);
    EXPECT_EQ(frame_.density.size(), frame_.positions.size());
  }
}

TEST(SimulationThreadPace, RealTimeIsNotOutrun) {
  SimulationThread simulation(smallScene(), 1, Pace::realTime);
  FrameSnapshot frame;
  const auto start = std::chrono::steady_clock::now();
  simulation.play();
  ASSERT_TRUE(waitFor(simulation, frame, [&] { return frame.info.time > 0.2; }));
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GT(wall, 0.19) << "40 frames of 5 ms";
}

}  // namespace
}  // namespace migiwa
