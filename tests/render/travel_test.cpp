// The simulation on its way to another time: what is asked for meanwhile, and what goes wrong.
#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>

#include "core/solver/effect.h"
#include "tests/render/test_scene.h"
#include "tests/render/time_line_runs.h"

namespace migiwa {
namespace travel_test {

/// Counts the frames that are begun, holds the one that is, or throws in the midst of it.
class Gate : public EffectOf<Gate> {
 public:
  static inline std::atomic<long> begun = 0;
  static inline std::atomic<bool> closed = false, throws = false;

  static void fields(auto&, auto&) {}
  EffectStages stages() const override { return {.prediction = true}; }
  void changePrediction(StepState&, std::span<EffectBuffer>) const override {
    ++begun;
    while (closed) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (throws) throw std::runtime_error("in the midst of a frame");
  }
};

Scene gatedScene() {
  Scene scene = smallScene();
  scene.effects.push_back({"gate", std::make_shared<Gate>()});
  return scene;
}

class Travel : public TimeLineTest {
 protected:
  ~Travel() override { Gate::closed = Gate::throws = false; }

  /// Asks for something that begins a frame, and stays in that until the gate is open.
  void beginFrame(const std::function<void()>& ask) {
    Gate::closed = true;
    const long before = Gate::begun;
    ask();
    for (int k = 0; k < 300000 && Gate::begun == before; ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_GT(Gate::begun, before);
  }
  /// The same with the first frame on the way.
  void setOut(int branch, double time) {
    beginFrame([&] { simulation_->goTo(branch, time); });
  }
  void openGateAndArrive() {
    Gate::closed = false;
    arrive();
  }
  /// Two branches of a gated scene: 60 frames with gamma, and 30 from frame 20 on without; at the end of the
  /// second one. `panel_` is what a window shows.
  void openTwoBranches() {
    const Scene scene = gatedScene();
    open(scene, 1);  // only what a branch begins with is kept
    stepOn(60);
    goTo(1, 20 * 0.005);
    simulation_->takeSettings();
    panel_ = without(scene);
    simulation_->apply(panel_);
    stepOn(30);
    look();
    ASSERT_EQ(simulation_->status().line.branch, 2);
    ASSERT_EQ(handling(), "no correction");
  }
  /// As a window does before it draws.
  void look() { panel_ = simulation_->takeSettings().value_or(panel_); }
  /// That of the next frame, and so the one in force.
  std::string handling() {
    stepOn(1);
    return frame_.info.handling;
  }
  void expectPanelIsInForce() {
    look();
    const bool none = panel_.boundary.handling == BoundaryHandling::none;
    EXPECT_EQ(handling() == "no correction", none);
  }

  Settings panel_;
};

TEST_F(Travel, AWayThatIsOvertakenIsDropped) {
  open(gatedScene(), 1);
  stepOn(100);
  const Straight straight = Straight::run(smallScene(), 100);
  setOut(1, straight.times[99]);
  const long begun = Gate::begun;
  for (int k = 0; k < 200; ++k) simulation_->goTo(1, straight.times[static_cast<std::size_t>(k * 37 % 100)]);
  simulation_->goTo(1, straight.times[63]);
  openGateAndArrive();
  EXPECT_EQ(Gate::begun - begun, 62) << "the first way had come to frame 1";
  EXPECT_EQ(frame(), 63);
  EXPECT_EQ(hash(), straight.hashes[63]);
  EXPECT_FALSE(simulation_->status().playing);
  simulation_->play();
  for (int k = 0; k < 300000 && frame() < 110; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_GE(frame(), 110) << "it plays on from there, and beyond its end";
}

TEST_F(Travel, SettingsThatAreAskedForOnTheWayStayThoseOfThePanel) {
  ASSERT_NO_FATAL_FAILURE(openTwoBranches());
  ASSERT_NO_FATAL_FAILURE(setOut(1, 50 * 0.005));
  look();
  EXPECT_EQ(panel_.boundary.handling, BoundaryHandling::gamma)
      << "those of the branch, from the start of the way";
  panel_.boundary.handling = BoundaryHandling::none;
  simulation_->apply(panel_);
  openGateAndArrive();
  EXPECT_FALSE(simulation_->takeSettings());
  EXPECT_EQ(frame(), 50);
  expectPanelIsInForce();
}

TEST_F(Travel, WhatIsAskedForInTheFrameBeforeItHasItsOrder) {
  for (const bool settingsFirst : {true, false}) {
    ASSERT_NO_FATAL_FAILURE(openTwoBranches());
    panel_.solver.tolerance = 0.03;
    ASSERT_NO_FATAL_FAILURE(beginFrame([&] { simulation_->step(); }));
    if (settingsFirst) simulation_->apply(panel_);
    simulation_->goTo(1, 50 * 0.005);
    if (!settingsFirst) simulation_->apply(panel_);
    openGateAndArrive();
    EXPECT_EQ(frame(), 50);
    EXPECT_EQ(simulation_->status().line.branch, settingsFirst ? 1 : 3);
    expectPanelIsInForce();
    EXPECT_EQ(panel_.boundary.handling, settingsFirst ? BoundaryHandling::gamma : BoundaryHandling::none);
  }
}

TEST_F(Travel, ASliderOnTheWayIsOfTheBranchThatItGoesTo) {
  ASSERT_NO_FATAL_FAILURE(openTwoBranches());
  ASSERT_NO_FATAL_FAILURE(setOut(1, 50 * 0.005));
  look();
  panel_.solver.tolerance = 0.03;
  simulation_->apply(panel_);
  openGateAndArrive();
  EXPECT_EQ(handling().find("gamma"), 0U) << frame_.info.handling;
  EXPECT_EQ(simulation_->status().line.branches.back().name, "/solver/tolerance=0.03");
}

TEST_F(Travel, AResetOnTheWayBeginsWithTheSettingsOfThePanel) {
  ASSERT_NO_FATAL_FAILURE(openTwoBranches());
  ASSERT_NO_FATAL_FAILURE(setOut(1, 50 * 0.005));
  simulation_->reset();
  openGateAndArrive();
  EXPECT_EQ(frame(), 0);
  expectPanelIsInForce();
}

TEST_F(Travel, ALoadOnTheWayThatFailsEndsItThere) {
  ASSERT_NO_FATAL_FAILURE(openTwoBranches());
  ASSERT_NO_FATAL_FAILURE(setOut(1, 50 * 0.005));
  simulation_->loadState(freshFolder("no_save") / "none.save");
  openGateAndArrive();
  EXPECT_FALSE(simulation_->status().stateFaults.empty());
  EXPECT_EQ(frame(), 1) << "the frame that was being computed";
  EXPECT_DOUBLE_EQ(frame_.info.time, simulation_->status().line.time);
  expectPanelIsInForce();
}

TEST_F(Travel, AFrameThatHasThrownIsNotGoneOnFrom) {
  open(gatedScene());
  stepOn(30);
  const Straight straight = Straight::run(smallScene(), 40);
  Gate::throws = true;
  simulation_->step();
  for (int k = 0; k < 300000 && !simulation_->status().stopped; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_EQ(simulation_->status().trouble, "in the midst of a frame");
  Gate::throws = false;
  goTo(1, 1);
  EXPECT_FALSE(simulation_->status().stopped);
  EXPECT_EQ(frame(), 30);
  EXPECT_EQ(hash(), straight.hashes[30]);
  stepOn(10);
  EXPECT_EQ(hash(), straight.hashes[40]);
}

TEST_F(Travel, AThrowOnTheWayLeavesThePanelWithWhatIsInForce) {
  ASSERT_NO_FATAL_FAILURE(openTwoBranches());
  ASSERT_NO_FATAL_FAILURE(setOut(1, 50 * 0.005));
  Gate::throws = true;
  Gate::closed = false;
  for (int k = 0; k < 300000 && !simulation_->status().stopped; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  Gate::throws = false;
  look();
  panel_.solver.tolerance = 0.03;
  simulation_->apply(panel_);
  arrive();
  EXPECT_EQ(simulation_->status().line.branch, 1) << "none begins in the midst of a frame";
  simulation_->reset();
  arrive();
  expectPanelIsInForce();
}

}  // namespace travel_test
}  // namespace migiwa
