// Going back in a run and on from there: every frame has the bits of a run that went straight there.
#include "app/session/time_line.h"

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "tests/render/test_scene.h"
#include "tests/render/time_line_runs.h"
#include "tests/support/test_effects.h"

namespace migiwa {
namespace time_line_test {

/// A wheel that turns, a tap, a drain and a gauge: all that a state is made of beside particles.
Scene busyScene() {
  return parseScene(R"({
    "format": 1, "particle_spacing": 0.1, "gravity": [0, -9.81, 0],
    "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [1, 0.4, 0.5]}],
    "emitters": [{"shape": "disc", "center": [0.5, 0.9, 0.25], "direction": [0, -1, 0], "radius": 0.15, "rate": 0.05}],
    "drains": [{"shape": "box", "min": [0.8, 0, 0], "max": [1, 0.1, 0.2], "start": 0.2}],
    "gauges": [{"kind": "height", "name": "level", "at": [0.8, 0, 0.25]}],
    "boundary": {"surfaces": [
      {"shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5]},
      {"shape": "box", "fluid": "outside", "min": [0.3, 0.1, 0.1], "max": [0.5, 0.3, 0.4],
       "motion": {"rotation": {"axis": [0, 0, 1], "point": [0.4, 0.2, 0.25], "degrees_per_second": 150}, "stop": 0.5}}]},
    "solver": {"time_step": 0.005, "max_iterations": 4}
  })",
                    "busy.json");
}

Settings coarser(const Scene& scene) {
  Settings settings{scene.solver, scene.boundary, scene.effects};
  settings.solver.timeStep = 0.008;
  settings.solver.supportRatio = 2.2;
  return settings;
}

TEST_F(TimeLineTest, AnyFrameIsThatOfTheStraightRun) {
  open(smallScene());
  stepOn(150);
  expectStraight(Straight::run(smallScene(), 150), 1, 100);
}

TEST_F(TimeLineTest, WallsThatMoveTapsAndDrainsGoBackToo) {
  open(busyScene());
  stepOn(120);
  expectStraight(Straight::run(busyScene(), 120), 1, 60);
}

TEST_F(TimeLineTest, SettingsThatWereChangedOnTheWayAreThoseOfTheirTime) {
  const Scene scene = smallScene();
  open(scene);
  const Settings first = without(scene), second = coarser(scene);
  stepOn(33);
  simulation_->apply(first);
  stepOn(20);
  simulation_->apply(second);
  stepOn(40);
  const Straight straight = Straight::run(scene, 93, [&](Simulation& simulation, long frame) {
    if (frame == 33) simulation.apply(first);
    if (frame == 53) simulation.apply(second);
  });
  ASSERT_EQ(hash(), straight.hashes.back());
  expectStraight(straight, 1, 60);
  EXPECT_EQ(simulation_->status().line.branches.size(), 1U) << "nothing was changed at an earlier time";
  simulation_->takeSettings();
  goTo(1, straight.times[40]);
  ASSERT_TRUE(simulation_->takeSettings());
  EXPECT_EQ(frame_.info.handling, "no correction");
  goTo(1, straight.times[20]);
  const std::optional<Settings> then = simulation_->takeSettings();
  ASSERT_TRUE(then);
  EXPECT_EQ(then->boundary.handling, BoundaryHandling::gamma);
  // Played again from there, they come into force where they did.
  stepOn(73);
  EXPECT_EQ(hash(), straight.hashes.back());
}

TEST_F(TimeLineTest, StepsBackFrameByFrameAndNoneIsLost) {
  open(smallScene());
  stepOn(50);
  const Straight straight = Straight::run(smallScene(), 50);
  for (long k = 49; k > 45; --k) {
    simulation_->stepBack();
    arrive();
    ASSERT_EQ(frame(), k);
    ASSERT_EQ(hash(), straight.hashes[static_cast<std::size_t>(k)]);
  }
  for (int k = 0; k < 20; ++k) simulation_->stepBack();
  arrive();
  EXPECT_EQ(frame(), 26);
  EXPECT_EQ(hash(), straight.hashes[26]);
  for (int k = 0; k < 40; ++k) simulation_->stepBack();
  arrive();
  EXPECT_EQ(frame(), 0) << "there is nothing before the start";
  EXPECT_EQ(hash(), straight.hashes[0]);
}

TEST_F(TimeLineTest, OtherSettingsAtAnEarlierTimeBeginABranchThatIsNamed) {
  const Scene scene = smallScene();
  open(scene);
  stepOn(80);
  const Straight straight = Straight::run(scene, 80);
  goTo(1, straight.times[30]);
  simulation_->apply(without(scene));
  stepOn(40);
  const Straight other = Straight::run(scene, 70, [&](Simulation& simulation, long frame) {
    if (frame == 30) simulation.apply(without(scene));
  });
  EXPECT_EQ(hash(), other.hashes[70]);
  const TimeLineView line = simulation_->status().line;
  ASSERT_EQ(line.branches.size(), 2U);
  EXPECT_EQ(line.branch, 2);
  EXPECT_EQ(line.branches[1].name, "/boundary/handling=none");
  EXPECT_DOUBLE_EQ(line.branches[1].from, straight.times[30]);
  EXPECT_DOUBLE_EQ(line.branches[1].until, other.times[70]);
  EXPECT_DOUBLE_EQ(line.branches[0].until, straight.times[80]);

  goTo(1, straight.times[75]);
  EXPECT_EQ(hash(), straight.hashes[75]) << "the run that it went from is as it was";
  goTo(2, other.times[44]);
  EXPECT_EQ(hash(), other.hashes[44]);
  goTo(2, other.times[30]);
  EXPECT_EQ(frame(), 30);
  simulation_->stepBack();
  arrive();
  EXPECT_EQ(simulation_->status().line.branch, 1);
  EXPECT_EQ(frame(), 29);
  EXPECT_EQ(hash(), straight.hashes[29]);
}

TEST_F(TimeLineTest, ASliderThatMovesMakesOneBranch) {
  const Scene scene = smallScene();
  open(scene);
  stepOn(30);
  goTo(1, 0.05);
  Settings settings{scene.solver, scene.boundary, scene.effects};
  for (const double tolerance : {0.02, 0.03, 0.04}) {
    settings.solver.tolerance = tolerance;
    simulation_->apply(settings);
    arrive();
  }
  TimeLineView line = simulation_->status().line;
  ASSERT_EQ(line.branches.size(), 2U);
  EXPECT_EQ(line.branches[1].name, "/solver/tolerance=0.04");
  stepOn(10);
  const Straight straight = Straight::run(scene, 20, [&](Simulation& simulation, long frame) {
    if (frame == 10) simulation.apply(settings);
  });
  EXPECT_EQ(hash(), straight.hashes[20]);
  goTo(2, straight.times[15]);
  EXPECT_EQ(hash(), straight.hashes[15]);
}

TEST_F(TimeLineTest, TheSameSettingsBeginNoBranch) {
  const Scene scene = smallScene();
  open(scene);
  stepOn(30);
  goTo(1, 0.05);
  simulation_->apply({scene.solver, scene.boundary, scene.effects});
  arrive();
  EXPECT_EQ(simulation_->status().line.branches.size(), 1U);
  Settings settings{scene.solver, scene.boundary, testing::effectsOf(R"({"viscosity": {"xsph": 0.3}})")};
  for (const char* effects : {R"({"viscosity": {"xsph": 0.1}})", R"({"viscosity": {}})", "{}"}) {
    simulation_->apply(settings);
    stepOn(10);
    goTo(simulation_->status().line.branch, 0.05 + 0.025);
    settings.effects = testing::effectsOf(effects);
    const std::size_t before = simulation_->status().line.branches.size();
    simulation_->apply(settings);
    arrive();
    EXPECT_EQ(simulation_->status().line.branches.size(), before + 1) << effects;
  }
}

TEST_F(TimeLineTest, StepsBackFromWhereItGoesThroughBranchesThatBeganAtOneFrame) {
  const Scene scene = smallScene();
  open(scene);
  stepOn(30);
  const Straight straight = Straight::run(scene, 30);
  Settings settings = without(scene);
  for (const double tolerance : {0.02, 0.03}) {
    goTo(simulation_->status().line.branch, straight.times[10]);
    settings.solver.tolerance = tolerance;
    simulation_->apply(settings);
    stepOn(10);
  }
  ASSERT_EQ(simulation_->status().line.branch, 3);
  goTo(3, straight.times[10]);
  simulation_->stepBack();
  arrive();
  EXPECT_EQ(simulation_->status().line.branch, 1);
  EXPECT_EQ(frame(), 9);
  EXPECT_EQ(hash(), straight.hashes[9]);

  goTo(3, straight.times[20]);
  simulation_->goTo(1, straight.times[27]);
  for (int k = 0; k < 3; ++k) simulation_->stepBack();
  arrive();
  EXPECT_EQ(simulation_->status().line.branch, 1);
  EXPECT_EQ(frame(), 24);
  EXPECT_EQ(hash(), straight.hashes[24]);
}

TEST_F(TimeLineTest, WhileTheRunIsHeldItStays) {
  open(smallScene());
  stepOn(20);
  simulation_->hold("a test");
  simulation_->goTo(1, 0.02);
  EXPECT_EQ(simulation_->status().refused, "Going to another time refused: a test");
  simulation_->stepBack();
  EXPECT_EQ(simulation_->status().refused, "Step back refused: a test");
  simulation_->release();
  arrive();
  EXPECT_EQ(frame(), 20);
}

TEST_F(TimeLineTest, ResetBeginsAnotherLine) {
  open(smallScene());
  stepOn(30);
  goTo(1, 0.02);
  simulation_->apply(without(smallScene()));
  simulation_->reset();
  arrive();
  const TimeLineView line = simulation_->status().line;
  ASSERT_EQ(line.branches.size(), 1U);
  EXPECT_EQ(line.branches[0].until, 0);
  EXPECT_EQ(line.frame, 0);
}

TEST_F(TimeLineTest, AStateAskedForAfterAResetIsTheStart) {
  open(smallScene());
  std::mt19937 engine(3);
  const Settings settings[] = {without(smallScene()), coarser(smallScene())};
  for (int k = 0; k < 300; ++k) {
    stepOn(1);
    simulation_->apply(settings[k % 2]);
    std::this_thread::sleep_for(std::chrono::microseconds(engine() % 500));
    simulation_->reset();
    arrive();
    ASSERT_EQ(frame(), 0) << "round " << k;
    ASSERT_EQ(frame_.info.time, 0) << "round " << k;
  }
}

/// As a simulation's thread does it, on this one.
TEST(TimeLineMemory, StaysWithinItsBoundAndEverythingInReach) {
  Simulation simulation(smallScene(), 1);
  const std::size_t one = StateImage::of(simulation).bytes();
  const std::size_t limit = 8 * one;
  TimeLine line(limit);
  line.begin(simulation);
  Straight straight;
  straight.take(simulation);
  for (int frame = 0; frame < 600; ++frame) {
    simulation.advanceFrame();
    line.reached(simulation);
    straight.take(simulation);
    ASSERT_LE(line.view(simulation).bytes, limit);
  }
  const TimeLineView view = line.view(simulation);
  ASSERT_GE(view.branches[0].kept.size(), 3U);
  EXPECT_EQ(view.branches[0].kept.front(), 0) << "the start is kept";
  for (const long frame : {599L, 301L, 77L, 0L}) {
    const TimeLine::Origin origin = line.origin(1, frame, 0);
    ASSERT_LE(origin.frame, frame);
    Simulation again(smallScene(), 1);
    origin.image->restore(again);
    while (again.frame() < frame) again.advanceFrame();
    EXPECT_EQ(again.stateHash(), straight.hashes[static_cast<std::size_t>(frame)]) << frame;
  }
}

TEST(TimeLineMemory, BranchesThatAreNoLongerKeptAreTheOldest) {
  const Scene scene = smallScene();
  Simulation simulation(scene, 1);
  TimeLine line;
  line.begin(simulation);
  for (std::size_t k = 0; k < TimeLine::kMostBranches + 3; ++k) {
    // A frame on, and back to the one before it, where something is changed.
    const StateImage here = StateImage::of(simulation);
    simulation.advanceFrame();
    line.reached(simulation);
    here.restore(simulation);
    Settings settings{scene.solver, scene.boundary, scene.effects};
    settings.solver.maxIterations = 5 + static_cast<int>(k);
    const Settings before = simulation.settings();
    simulation.apply(settings);
    line.changed(simulation, before);
  }
  const TimeLineView view = line.view(simulation);
  ASSERT_EQ(view.branches.size(), TimeLine::kMostBranches);
  EXPECT_EQ(view.branches.front().number, 1);
  EXPECT_EQ(view.branches.back().number, view.branch);
  EXPECT_EQ(view.branches[1].number, 6);
}

}  // namespace time_line_test
}  // namespace migiwa
