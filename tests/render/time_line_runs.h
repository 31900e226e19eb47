// Runs with a time line for the tests that go back in them, and the runs to compare with.
#pragma once

#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "app/session/session.h"
#include "core/scene/scene_file.h"

namespace migiwa {

inline Settings without(const Scene& scene) {
  Settings settings{scene.solver, scene.boundary, scene.effects};
  settings.boundary.handling = BoundaryHandling::none;
  return settings;
}

/// Of a run that goes straight on, after every frame: the hash and the time.
struct Straight {
  std::vector<std::uint64_t> hashes;
  std::vector<double> times;

  void take(const Simulation& simulation) {
    hashes.push_back(simulation.stateHash());
    times.push_back(simulation.time());
  }
  /// `change` is called before each frame.
  static Straight run(
      const Scene& scene, long frames,
      const std::function<void(Simulation&, long)>& change = [](Simulation&, long) {}) {
    Straight straight;
    Simulation simulation(scene, 1);
    straight.take(simulation);
    for (long frame = 0; frame < frames; ++frame) {
      change(simulation, frame);
      simulation.advanceFrame();
      straight.take(simulation);
    }
    return straight;
  }
};

class TimeLineTest : public ::testing::Test {
 protected:
  void open(const Scene& scene, std::size_t past = TimeLine::kLimit) {
    simulation_ = std::make_unique<SimulationThread>(scene, 1, Pace::unlimited, past);
  }

  /// Waits until nothing is under way, and takes the frame that is shown then.
  void arrive() {
    for (int k = 0; k < 300000; ++k) {
      if (!simulation_->status().line.underWay) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    simulation_->capture().get();
    simulation_->takeFrame(frame_);
  }
  void stepOn(long frames) {
    const long end = simulation_->status().line.frame + frames;
    for (long k = 0; k < frames; ++k) simulation_->step();
    for (int k = 0; k < 300000 && simulation_->status().line.frame < end; ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    arrive();
  }
  void goTo(int branch, double time) {
    simulation_->goTo(branch, time);
    arrive();
  }
  long frame() const { return simulation_->status().line.frame; }
  std::uint64_t hash() const { return frame_.info.stateHash; }

  /// Every frame of the present branch in random order, `times` of them.
  void expectStraight(const Straight& straight, int branch, int times) {
    std::mt19937 engine(7);
    for (int k = 0; k < times; ++k) {
      const std::size_t to = engine() % straight.hashes.size();
      goTo(branch, straight.times[to]);
      ASSERT_EQ(frame(), static_cast<long>(to)) << straight.times[to];
      ASSERT_EQ(hash(), straight.hashes[to]) << "frame " << to << ", visit " << k;
      ASSERT_EQ(frame_.info.time, straight.times[to]);
    }
  }

  std::unique_ptr<SimulationThread> simulation_;
  FrameSnapshot frame_;
};

}  // namespace migiwa
