// A simulation on a thread of its own, so that an interface stays quick while a step is slow. Wishes are
// carried out between frames; finished frames are handed over as copies. No window, no OpenGL.
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "app/ui/panel_model.h"
#include "core/scene/scene_reader.h"
#include "core/simulation/simulation.h"
#include "core/simulation/state_image.h"

namespace migiwa {

/// How fast frames may follow each other. The physics never sees a clock; this only waits between frames.
enum class Pace { realTime, unlimited };

class SimulationThread {
 public:
  /// Fills the scene on the calling thread; `threads` as for Simulation.
  SimulationThread(const Scene& scene, int threads, Pace pace);
  /// Waits for the frame that is being computed; a state that is still to be saved is saved.
  ~SimulationThread();
  SimulationThread(const SimulationThread&) = delete;
  SimulationThread& operator=(const SimulationThread&) = delete;

  // What cannot be done now is refused, and the status says so: all but pausing, settings and pressures while
  // the simulation is held, and playing and stepping once it has stopped itself.

  void play();
  void pause();
  /// Pauses, and computes one frame more.
  void step();
  /// Back to the start, with the settings of now; goes on playing if it did.
  void reset();
  /// Takes effect with the next frame. Where the simulation cannot do with them, the status says why, and
  /// those of before stay in force: takeRefusal() has them.
  void apply(const Settings& settings);
  /// The settings in force where others were refused since the last call.
  std::optional<Settings> takeRefusal();
  /// From the next frame on, frames have pressures, or none.
  void watchPressure(bool on);

  // The state on disk, as `migiwa simulate --save` and `--resume` keep it (core/io/save_file.h). What became
  // of it is in the status; faults leave the simulation as it is.

  /// Writes the state between two frames. `overrides`: those that the scene was read with, for people to see.
  void saveState(std::filesystem::path file, std::vector<Override> overrides);
  /// Goes on from a save of this scene with the settings of now; plays on if it did.
  void loadState(std::filesystem::path file);

  /// No frame begins until release(), whether it plays or not. `why`: who holds it and what for, such as
  /// "\"What if\" measures".
  void hold(std::string why);
  /// Goes on playing if it did and was not paused since.
  void release();

  /// The state between two frames, to go on from elsewhere. Whoever waits for it waits for the frame that is
  /// being computed, at most; std::future_error where the simulation ends first.
  std::future<StateImage> capture();

  /// Swaps the newest frame into `frame` if there is one that was not taken yet.
  bool takeFrame(FrameSnapshot& frame);
  RunStatus status() const;
  /// The scene as it was filled, with the warnings of that.
  const Scene& scene() const { return scene_; }
  /// Walls for drawing.
  const WallDrawing& walls() const { return walls_; }

 private:
  using Clock = std::chrono::steady_clock;

  void work();
  bool waitForWork(std::unique_lock<std::mutex>& lock);
  void carryOutWishes(std::unique_lock<std::mutex>& lock);
  void carryOutSettings(std::unique_lock<std::mutex>& lock);
  void carryOutSave(std::unique_lock<std::mutex>& lock);
  void carryOutLoad(std::unique_lock<std::mutex>& lock);
  // With the lock held.
  bool mayAdvance() const;
  bool refuses(const char* wish, bool needsGoodState);
  void begin();
  void stop(std::string why);
  void advance(std::unique_lock<std::mutex>& lock);
  void publish(std::unique_lock<std::mutex>& lock);

  const int threads_;
  const Pace pace_;
  // Of the simulation's thread alone, once it runs.
  std::unique_ptr<Simulation> simulation_;
  FrameSnapshot filling_;
  Clock::time_point due_{};

  const Scene scene_;
  const WallDrawing walls_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  FrameSnapshot finished_;
  bool hasFrame_ = false;
  RunStatus status_;
  bool reset_ = false, quit_ = false;
  struct Save {
    std::filesystem::path file;
    std::vector<Override> overrides;
  };
  std::optional<Save> save_;
  std::optional<std::filesystem::path> load_;
  std::vector<std::promise<StateImage>> captures_;
  int steps_ = 0;
  std::optional<Settings> settings_, refused_;
  bool watchPressure_;

  std::thread thread_;
};

}  // namespace migiwa
