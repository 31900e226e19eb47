// The simulation's thread without a window; run it under the thread sanitizer, too.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include "app/session/session.h"
#include "core/io/save_file.h"
#include "core/scene/scene_file.h"
#include "core/walls/shapes.h"
#include "tests/render/test_scene.h"
#include "tests/support/test_effects.h"

namespace migiwa {
namespace simulation_thread_test {

/// Takes frames until one satisfies `wanted`; fails after half a minute.
bool waitFor(SimulationThread& simulation, FrameSnapshot& frame, const std::function<bool()>& wanted) {
  for (int i = 0; i < 30000; ++i) {
    simulation.takeFrame(frame);
    if (wanted()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

class SimulationThreadTest : public ::testing::Test {
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

TEST_F(SimulationThreadTest, WaterIsMadeWhenItIsAskedForAlsoOfAFrameThatIsThere) {
  ASSERT_TRUE(simulation_.takeFrame(frame_));
  EXPECT_EQ(frame_.water, nullptr);
  simulation_.watchWater(true);
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.water != nullptr; }));
  EXPECT_EQ(frame_.info.time, 0);
  EXPECT_FALSE(frame_.water->empty());
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_FALSE(simulation_.takeFrame(frame_)) << "it is made once";
  simulation_.watchWater(false);
  simulation_.step();
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.info.time > 0; }));
  EXPECT_EQ(frame_.water, nullptr);
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

TEST_F(SimulationThreadTest, FramesHavePressuresWhileTheyAreWatchedAndAfterAReset) {
  const auto at = [&](double time) {
    return waitFor(simulation_, frame_, [&] { return std::abs(frame_.info.time - time) < 1e-9; });
  };
  simulation_.step();
  ASSERT_TRUE(at(0.005));
  EXPECT_TRUE(frame_.pressure.empty());
  simulation_.watchPressure(true);
  simulation_.step();
  ASSERT_TRUE(at(0.01));
  EXPECT_EQ(frame_.pressure.size(), frame_.positions.size());
  simulation_.reset();
  simulation_.step();
  ASSERT_TRUE(at(0.005));
  EXPECT_EQ(frame_.pressure.size(), frame_.positions.size());
  simulation_.watchPressure(false);
  simulation_.step();
  ASSERT_TRUE(at(0.01));
  EXPECT_TRUE(frame_.pressure.empty());
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

/// The stages that a frame lists, but for those of a step without effects.
std::vector<std::string> effectStages(const FrameSnapshot& frame) {
  std::vector<std::string> names;
  for (const StageTime& stage : frame.info.stages.stages())
    if (std::ranges::find(effectNames(), stage.name) != effectNames().end()) names.push_back(stage.name);
  return names;
}

TEST_F(SimulationThreadTest, EffectsTakenOverLiveHoldFromTheNextFrame) {
  using Names = std::vector<std::string>;
  constexpr int kFrames = 4;
  Settings settings{scene_.solver, scene_.boundary, scene_.effects};
  ASSERT_TRUE(settings.effects.empty());
  Simulation reference(scene_, 1), without(scene_, 1);
  long frames = 0;
  const auto stepBoth = [&] {
    for (int k = 0; k < kFrames; ++k) {
      const double before = frame_.info.time;
      simulation_.step();
      ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return frame_.info.time > before; }));
      reference.advanceFrame(), without.advanceFrame();
      ASSERT_EQ(frame_.info.stateHash, reference.stateHash()) << "frame " << ++frames;
    }
  };
  const auto apply = [&](const std::string& effects) {
    settings.effects = testing::effectsOf(effects);
    simulation_.apply(settings);
    reference.apply(settings);
  };
  ASSERT_NO_FATAL_FAILURE(stepBoth());
  EXPECT_EQ(effectStages(frame_), Names{});
  const std::size_t stagesWithout = frame_.info.stages.stages().size();

  // Added: it has its stage, and works, from the first frame on.
  apply(R"({"viscosity": {"xsph": 0.3}})");
  const std::uint64_t before = reference.stateHash();
  ASSERT_NO_FATAL_FAILURE(stepBoth());
  EXPECT_EQ(effectStages(frame_), Names{"viscosity"});
  EXPECT_EQ(frame_.info.stages.stages().size(), stagesWithout + 1);
  EXPECT_NE(frame_.info.stateHash, before);
  EXPECT_NE(frame_.info.stateHash, without.stateHash()) << "the effect did nothing";

  // One more, and the first with another value.
  apply(R"({"viscosity": {"xsph": 0.1}, "artificial_pressure": {}})");
  ASSERT_NO_FATAL_FAILURE(stepBoth());
  EXPECT_EQ(effectStages(frame_), (Names{"artificial_pressure", "viscosity"}));

  // All removed: the stages are those of the start, and the run is one that goes on without any.
  apply("{}");
  ASSERT_NO_FATAL_FAILURE(stepBoth());
  EXPECT_EQ(effectStages(frame_), Names{});
  EXPECT_EQ(frame_.info.stages.stages().size(), stagesWithout);
}

TEST(MovingWallsOfAThread, AreInEachFrameWhereTheyWereThen) {
  const Scene scene = parseScene(R"({
    "format": 1, "particle_spacing": 0.1, "gravity": [0, 0, 0],
    "fluid": [{"shape": "box", "min": [1, 0, 0], "max": [1.4, 0.4, 0.4]}],
    "boundary": {"surfaces": [{"shape": "box", "fluid": "outside", "min": [0, 0, 0], "max": [0.2, 1, 0.5],
                               "motion": {"velocity": [-1, 0, 0]}}]},
    "solver": {"time_step": 0.005}
  })",
                                 "moving.json");
  SimulationThread simulation(scene, 1, Pace::unlimited);
  FrameSnapshot frame;
  const auto place = [&] {
    double sum = 0;
    for (const LineSegment& line : frame.walls->lines)
      sum += static_cast<double>(line.from.x() + line.to.x());
    return sum / (2 * static_cast<double>(frame.walls->lines.size()));
  };
  ASSERT_TRUE(simulation.takeFrame(frame));
  ASSERT_NE(frame.walls, nullptr);
  EXPECT_NEAR(place(), 0.1, 1e-6);
  for (int k = 0; k < 5; ++k) {
    const double before = frame.info.time;
    simulation.step();
    ASSERT_TRUE(waitFor(simulation, frame, [&] { return frame.info.time > before; }));
    ASSERT_NE(frame.walls, nullptr);
    EXPECT_NEAR(place(), 0.1 - frame.info.time, 1e-6);
  }
  simulation.reset();
  ASSERT_TRUE(waitFor(simulation, frame, [&] { return frame.info.time == 0; }));
  EXPECT_NEAR(place(), 0.1, 1e-6);
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
    for (int k = 0; k < 300000 && (status = simulation.status()).stateNote.empty(); ++k)
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
  for (int k = 0; k < 300000 && simulation_.status().stateFaults.empty(); ++k)
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

/// A tank in a sphere too large for a grid, which the method "baked" needs.
class RefusedSettingsTest : public ::testing::Test {
 protected:
  static Scene vastScene() {
    Scene scene = smallScene();
    scene.surfaces.push_back(std::make_shared<Sphere>(Vec3d::Zero(), 1e4, Sphere::Fluid::inside));
    return scene;
  }
  static Settings bakedOf(Settings settings) {
    const auto names = gammaMethodNames();
    settings.boundary.gammaMethod = static_cast<int>(std::ranges::find(names, "baked") - names.begin());
    settings.solver.maxIterations = 3;
    return settings;
  }
  Settings good() const { return {scene_.solver, scene_.boundary, scene_.effects}; }
  bool refused() {
    return waitFor(simulation_, frame_, [&] { return !simulation_.status().settingsFaults.empty(); });
  }
  std::uint64_t hashAfter(int frames) const {
    Simulation reference(scene_, 1);
    for (int k = 0; k < frames; ++k) reference.advanceFrame();
    return reference.stateHash();
  }
  /// Of a frame: a reset applies the settings in force, as if they were others.
  std::uint64_t hashAfterReset() const {
    Simulation reference(scene_, 1);
    reference.apply(good());
    reference.advanceFrame();
    return reference.stateHash();
  }
  bool at(double time) {
    return waitFor(simulation_, frame_, [&] { return std::abs(frame_.info.time - time) < 1e-9; });
  }

  const Scene scene_ = vastScene();
  SimulationThread simulation_{scene_, 1, Pace::unlimited};
  FrameSnapshot frame_;
};

TEST_F(RefusedSettingsTest, ThoseOfBeforeStayAndTheRunGoesOn) {
  simulation_.step();
  ASSERT_TRUE(at(0.005));
  EXPECT_FALSE(simulation_.takeSettings());
  simulation_.apply(bakedOf(good()));
  ASSERT_TRUE(refused());
  const RunStatus status = simulation_.status();
  EXPECT_NE(status.settingsFaults[0].find(":/boundary/gamma/method: expected "), std::string::npos)
      << status.settingsFaults[0];
  EXPECT_FALSE(status.stopped);
  const std::optional<Settings> inForce = simulation_.takeSettings();
  ASSERT_TRUE(inForce);
  EXPECT_EQ(inForce->boundary.gammaMethod, scene_.boundary.gammaMethod);
  EXPECT_EQ(inForce->solver.maxIterations, scene_.solver.maxIterations);
  EXPECT_FALSE(simulation_.takeSettings()) << "told once";
  simulation_.step();
  ASSERT_TRUE(at(0.01));
  EXPECT_EQ(frame_.info.stateHash, hashAfter(2));

  simulation_.apply(good());
  ASSERT_TRUE(waitFor(simulation_, frame_, [&] { return simulation_.status().settingsFaults.empty(); }));
}

TEST_F(RefusedSettingsTest, AResetWorks) {
  simulation_.step();
  ASSERT_TRUE(at(0.005));
  simulation_.apply(bakedOf(good()));
  ASSERT_TRUE(refused());
  simulation_.reset();
  ASSERT_TRUE(at(0));
  EXPECT_FALSE(simulation_.status().stopped) << simulation_.status().trouble;
  EXPECT_TRUE(simulation_.status().settingsFaults.empty());
  simulation_.step();
  ASSERT_TRUE(at(0.005));
  EXPECT_EQ(frame_.info.stateHash, hashAfterReset());

  // Both at once.
  simulation_.apply(bakedOf(good()));
  simulation_.reset();
  ASSERT_TRUE(at(0));
  EXPECT_FALSE(simulation_.status().stopped);
  simulation_.step();
  ASSERT_TRUE(at(0.005));
  EXPECT_EQ(frame_.info.stateHash, hashAfterReset());
}

TEST_F(SimulationThreadTest, ManyMayWriteTheSceneOutWhileItPlays) {
  simulation_.play();
  const std::string text = writeScene(scene_);
  std::vector<std::thread> writers;
  for (int k = 0; k < 3; ++k)
    writers.emplace_back([&] {
      for (int time = 0; time < 50; ++time) EXPECT_EQ(writeScene(simulation_.scene()), text);
    });
  for (std::thread& writer : writers) writer.join();
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

}  // namespace simulation_thread_test
}  // namespace migiwa
