// The simulation's thread without a window; run it under the thread sanitizer, too.
#include "app/viewer/simulation_thread.h"

#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include "core/io/save_file.h"
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

/// A state on disk, from one thread's simulation to another's and to that of the command line.
class SavedStateTest : public SimulationThreadTest {
 protected:
  ~SavedStateTest() override { std::filesystem::remove_all(folder_); }

  void stepTo(SimulationThread& simulation, double time) {
    while (frame_.info.time < time - 1e-9) {
      const double before = frame_.info.time;
      simulation.step();
      ASSERT_TRUE(waitFor(simulation, frame_, [&] { return frame_.info.time > before; }));
    }
  }
  /// Waits until the status says what became of it.
  RunStatus told(const SimulationThread& simulation) {
    RunStatus status;
    for (int k = 0; k < 30000 && (status = simulation.status()).stateNote.empty(); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return status;
  }
  /// Of a run to `time` that nobody interrupts; settings change at `changed`.
  std::uint64_t hashAt(double time, double changed, const Settings& settings) const {
    Simulation simulation(scene_, 1);
    while (simulation.time() < time - 1e-9) {
      if (std::abs(simulation.time() - changed) < 1e-9) simulation.apply(settings);
      simulation.advanceFrame();
    }
    return simulation.stateHash();
  }

  const std::filesystem::path folder_ = freshFolder("state");
  const std::filesystem::path file_ = folder_ / "small.save";
  Settings settings_{scene_.solver, scene_.boundary, scene_.effects};
};

TEST_F(SavedStateTest, GoesOnAsIfNothingHadHappened) {
  settings_.solver.maxIterations = 3;
  stepTo(simulation_, 0.03);
  simulation_.apply(settings_);
  stepTo(simulation_, 0.05);
  simulation_.saveState(file_, {});
  EXPECT_EQ(told(simulation_).stateNote, "Saved at 0.050 s: small.save");
  const std::uint64_t saved = frame_.info.stateHash;
  stepTo(simulation_, 0.1);
  const std::uint64_t uninterrupted = hashAt(0.1, 0.03, settings_);
  EXPECT_EQ(frame_.info.stateHash, uninterrupted) << "saving changes nothing";

  // Back, in the same window.
  simulation_.loadState(file_);
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.info.time < 0.06; }));
  EXPECT_EQ(frame_.info.stateHash, saved);
  EXPECT_FALSE(simulation_.status().playing);
  stepTo(simulation_, 0.1);
  EXPECT_EQ(frame_.info.stateHash, uninterrupted);

  // In another window, with another number of threads.
  SimulationThread other(scene_, 1, Pace::unlimited);
  other.apply(settings_);
  other.loadState(file_);
  ASSERT_TRUE(waitFor(other, frame_, [&] { return frame_.info.stateHash == saved; }));
  stepTo(other, 0.1);
  EXPECT_EQ(frame_.info.stateHash, uninterrupted);

  // And as `migiwa simulate --resume` does.
  Scene scene = scene_;
  scene.solver = settings_.solver;
  Simulation resumed(scene, 1);
  SettledSampler sampler;
  readSave(file_, resumed, sampler);
  while (resumed.time() < 0.1 - 1e-9) resumed.advanceFrame();
  EXPECT_EQ(resumed.stateHash(), uninterrupted);
}

TEST_F(SavedStateTest, WhatTheCommandLineSavedIsLoaded) {
  Simulation before(scene_, 1);
  for (int k = 0; k < 7; ++k) before.advanceFrame();
  SettledSampler sampler;
  sampler.sample(before);
  writeSave(file_, before, sampler, {});
  simulation_.play();
  simulation_.loadState(file_);
  EXPECT_EQ(told(simulation_).stateNote, "Loaded at 0.035 s: small.save");
  EXPECT_TRUE(simulation_.status().playing) << "plays on";
  simulation_.pause();
  // However far it has played since.
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.info.time > 0.034; }));
  EXPECT_EQ(frame_.info.stateHash, hashAt(frame_.info.time, -1, settings_)) << frame_.info.time;
}

TEST_F(SavedStateTest, FaultsLeaveTheSimulationAsItIs) {
  stepTo(simulation_, 0.01);
  simulation_.loadState(file_);
  RunStatus status = told(simulation_);
  ASSERT_EQ(status.stateFaults.size(), 1U);
  EXPECT_EQ(status.stateFaults[0], file_.string() + ": expected a save, found no such file");
  EXPECT_EQ(status.stateNote, "Not loaded, the simulation goes on:");

  // A save with other settings: each that differs is named.
  simulation_.saveState(file_, {});
  while (!simulation_.status().stateFaults.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  settings_.solver.maxIterations = 3;
  settings_.boundary.handling = BoundaryHandling::none;
  simulation_.apply(settings_);
  simulation_.loadState(file_);
  for (int k = 0; k < 30000 && simulation_.status().stateFaults.empty(); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  status = simulation_.status();
  ASSERT_EQ(status.stateFaults.size(), 2U);
  EXPECT_NE(status.stateFaults[0].find("/scene/boundary/handling: expected \"none\", found \"gamma\""),
            std::string::npos)
      << status.stateFaults[0];
  EXPECT_NE(status.stateFaults[1].find("/scene/solver/max_iterations: expected 3, found 4"),
            std::string::npos)
      << status.stateFaults[1];
  stepTo(simulation_, 0.02);
  EXPECT_EQ(frame_.info.stateHash, hashAt(0.02, 0.01, settings_));

  // A folder that is not there.
  simulation_.saveState(folder_ / "none" / "small.save", {});
  while (simulation_.status().stateNote != "Not saved:")
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(simulation_.status().stateFaults.size(), 1U);
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
