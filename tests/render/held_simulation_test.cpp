// A simulation that has to wait, for "What if" above all: what it refuses meanwhile, and how it goes on.
#include <gtest/gtest.h>

#include "app/session/session.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace held_simulation_test {

namespace fs = std::filesystem;

class HeldSimulation : public ::testing::Test {
 protected:
  ~HeldSimulation() override { fs::remove_all(folder_); }

  /// When the frame that was begun is done, and every wish of before carried out.
  void awaitRest() {
    simulation_.capture().get();
    simulation_.takeFrame(frame_);
  }
  /// Whether one more frame has begun since the last look; waits for it only where one has to come.
  bool movesOn(bool expected) {
    const double before = frame_.info.time;
    for (int k = 0; k < 300000 && expected && frame_.info.time <= before; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      simulation_.takeFrame(frame_);
    }
    // Each capture ends where a frame may begin.
    for (int k = 0; k < 3; ++k) awaitRest();
    return frame_.info.time > before;
  }
  std::string refused() const { return simulation_.status().refused; }
  Settings settings() const { return {scene_.solver, scene_.boundary, scene_.effects}; }

  const fs::path folder_ = freshFolder("held");
  const Scene scene_ = smallScene();
  SimulationThread simulation_{scene_, 1, Pace::unlimited};
  FrameSnapshot frame_;
};

TEST_F(HeldSimulation, WaitsAndPlaysOn) {
  simulation_.play();
  ASSERT_TRUE(movesOn(true));
  simulation_.hold("a test");
  awaitRest();
  EXPECT_FALSE(movesOn(false));
  EXPECT_TRUE(simulation_.status().playing);
  EXPECT_EQ(simulation_.status().heldFor, "a test");
  simulation_.release();
  EXPECT_TRUE(movesOn(true));
  EXPECT_EQ(simulation_.status().heldFor, "");
}

TEST_F(HeldSimulation, StaysPausedWhenItWasPausedMeanwhile) {
  simulation_.play();
  ASSERT_TRUE(movesOn(true));
  simulation_.hold("a test");
  simulation_.pause();
  EXPECT_EQ(refused(), "");
  awaitRest();
  simulation_.release();
  EXPECT_FALSE(simulation_.status().playing);
  EXPECT_FALSE(movesOn(false));
}

TEST_F(HeldSimulation, RefusesWhatCannotBeDoneMeanwhile) {
  simulation_.step();
  ASSERT_TRUE(movesOn(true));
  const double time = frame_.info.time;
  simulation_.hold("a test");
  simulation_.play();
  EXPECT_EQ(refused(), "Play refused: a test");
  EXPECT_FALSE(simulation_.status().playing);
  simulation_.step();
  EXPECT_EQ(refused(), "Step refused: a test");
  simulation_.reset();
  EXPECT_EQ(refused(), "Reset refused: a test");
  simulation_.saveState(folder_ / "held.save", {});
  EXPECT_EQ(refused(), "Save state refused: a test");
  simulation_.loadState(folder_ / "held.save");
  EXPECT_EQ(refused(), "Load state refused: a test");
  simulation_.release();
  EXPECT_EQ(refused(), "");
  EXPECT_FALSE(movesOn(false)) << "nothing is made up for";
  EXPECT_EQ(frame_.info.time, time);
  EXPECT_EQ(simulation_.status().stateNote, "");
  EXPECT_FALSE(fs::exists(folder_ / "held.save"));
  simulation_.step();
  EXPECT_TRUE(movesOn(true));
}

TEST_F(HeldSimulation, StepsAskedForBeforeAreTakenAfterwards) {
  simulation_.hold("a test");
  simulation_.release();
  simulation_.step();
  simulation_.hold("a test");
  simulation_.release();
  EXPECT_TRUE(movesOn(true));
  EXPECT_EQ(frame_.info.steps, 1);
}

TEST_F(HeldSimulation, EndsAtOnceAndSavesWhatWasAskedFor) {
  for (int k = 0; k < 20; ++k) {
    const fs::path file = folder_ / (std::to_string(k) + ".save");
    {
      SimulationThread simulation(scene_, 1, Pace::unlimited);
      simulation.saveState(file, {});
      simulation.hold("a test");
    }
    EXPECT_TRUE(fs::exists(file));
  }
}

TEST(StoppedSimulation, RefusesToPlayAndToStep) {
  // A lid that comes down on water until there is no room left.
  SimulationThread simulation(readScene(MIGIWA_SOURCE_DIR "/scenes/hard/lid_closed.json"), 1,
                              Pace::unlimited);
  simulation.play();
  for (int k = 0; k < 300000 && !simulation.status().stopped; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(simulation.status().stopped);
  simulation.play();
  EXPECT_EQ(simulation.status().refused, "Play refused: it has stopped");
  simulation.step();
  EXPECT_EQ(simulation.status().refused, "Step refused: it has stopped");
  simulation.reset();
  EXPECT_EQ(simulation.status().refused, "");
}

class WhatIfBesideARun : public HeldSimulation {
 protected:
  void ask() {
    model_.ask = true;
    ASSERT_TRUE(session_.poll(model_, simulation_, settings()));
    ASSERT_TRUE(model_.busy);
  }
  void takeAnswer() {
    session_.wait();
    ASSERT_TRUE(session_.poll(model_, simulation_, settings()));
    ASSERT_FALSE(model_.busy);
    EXPECT_EQ(simulation_.status().heldFor, "");
  }

  WhatIfModel model_;
  WhatIfSession session_{1};
};

TEST_F(WhatIfBesideARun, HoldsItAndLetsItPlayOn) {
  simulation_.play();
  ask();
  EXPECT_EQ(simulation_.status().heldFor, "\"What if\" measures");
  takeAnswer();
  EXPECT_TRUE(simulation_.status().playing);
  EXPECT_TRUE(movesOn(true));
  EXPECT_EQ(model_.points.size(), 1U);
}

TEST_F(WhatIfBesideARun, LeavesItPausedIfItWas) {
  ask();
  simulation_.play();
  takeAnswer();
  EXPECT_FALSE(simulation_.status().playing);
  EXPECT_FALSE(movesOn(false));
  EXPECT_EQ(frame_.info.time, 0);
}

TEST_F(WhatIfBesideARun, LeavesItPausedIfThatWasAskedForMeanwhile) {
  simulation_.play();
  ask();
  simulation_.pause();
  takeAnswer();
  EXPECT_FALSE(simulation_.status().playing);
  awaitRest();
  EXPECT_FALSE(movesOn(false));
}

TEST_F(WhatIfBesideARun, LetsItGoWhenItsSceneIsReplaced) {
  simulation_.play();
  ask();
  session_.forget(model_, simulation_);
  EXPECT_EQ(simulation_.status().heldFor, "");
  EXPECT_TRUE(movesOn(true));
  simulation_.hold("somebody else");
  session_.wait();
  ASSERT_TRUE(session_.poll(model_, simulation_, settings()));
  EXPECT_EQ(simulation_.status().heldFor, "somebody else") << "not the session's to release any more";
  EXPECT_TRUE(model_.points.empty());
}

TEST_F(WhatIfBesideARun, MeasuresWhileSettingsChange) {
  simulation_.play();
  ask();
  Settings changed = settings();
  for (int k = 0; k < 20; ++k) {
    changed.solver.maxIterations = 2 + k % 5;
    simulation_.apply(changed);
    simulation_.takeFrame(frame_);
    model_.clear = true;
    session_.poll(model_, simulation_, changed);
  }
  session_.wait();
  session_.poll(model_, simulation_, changed);
  ASSERT_EQ(model_.points.size(), 1U);
  EXPECT_NE(model_.points[0].label.find("at most 4 iterations"), std::string::npos) << model_.points[0].label;
  EXPECT_TRUE(movesOn(true));
}

}  // namespace held_simulation_test
}  // namespace migiwa
