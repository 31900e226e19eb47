// The simulation beside the window, without window and OpenGL: its thread, the scene's file while it is
// edited, and "What if".
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "app/session/time_line.h"
#include "app/session/ui_state.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/base/progress.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "core/simulation/state.h"
#include "core/study/study.h"

namespace migiwa {

// What a thread that prepares a scene is doing, for another one to show.

class PreparationStatus final : public ProgressObserver {
 public:
  void reached(std::string_view what, double part) override;
  void ended() override;
  /// Such as "fitting 2000 points: 45 %"; empty where nothing is done that takes long.
  std::string text() const;

 private:
  mutable std::mutex mutex_;
  std::string what_;
  double part_ = 0;
};

// Notices that files have changed, however they were written: in place, or anew and renamed over the old one.

class SceneWatch {
 public:
  explicit SceneWatch(std::vector<std::filesystem::path> files) { setFiles(std::move(files)); }

  /// Watches these from now on, and takes them as known.
  void setFiles(std::vector<std::filesystem::path> files);

  /// Watches these from now on; a change to one that was watched before is still told.
  void follow(std::vector<std::filesystem::path> files);

  /// Whether what is in the files has changed, and has been the same in the last two calls: while a file is
  /// still being written, or is missing for a moment, the answer is no. Cheap when nothing
  /// happened; a few calls a second are meant. A change is told once.
  bool poll();

 private:
  /// What changes with every change to a file, also where its time of writing was set back.
  struct Stamp {
    std::int64_t written = 0, changed = 0;  ///< since the epoch (ns)
    std::uint64_t size = 0, number = 0;     ///< the file's own in its file system
    bool operator==(const Stamp&) const = default;
  };
  struct Watched {
    std::filesystem::path file;
    std::optional<Stamp> stamp;  ///< when it was last read
    bool young = false;          ///< then it was so new that another change may bear the same time
    /// Of its bytes, which may be those of a large mesh; nothing: no file.
    std::optional<FileIdentity> content;
    std::optional<FileIdentity> told;  ///< the same, when a change was last told
  };

  /// Nothing: no ordinary file.
  static std::optional<Stamp> stampOf(const std::filesystem::path& file);
  /// Reads the file if it seems to have changed; returns whether its content did.
  static bool look(Watched& watched);

  std::vector<Watched> files_;
};

// A simulation on a thread of its own, so that an interface stays quick while a step is slow. UiCommands are
// carried out between frames; finished frames are handed over as copies. No window, no OpenGL.

/// The calling thread, and those that it starts from now on, let others go first where there are fewer
/// processors than threads: a simulation takes what drawing leaves.
void letOthersGoFirst();

/// How fast frames may follow each other. The physics does not depend on a clock; this only waits between
/// frames.
enum class Pace { realTime, unlimited };

class SimulationThread {
 public:
  /// Fills the scene on the calling thread; `threads` as for Simulation. `past`: bytes for the states of the
  /// time line.
  SimulationThread(const Scene& scene, int threads, Pace pace, std::size_t past = TimeLine::kLimit);
  /// Waits for the frame that is being computed; a state that is still to be saved is saved, after the frames
  /// to the time that it is on its way to.
  ~SimulationThread();
  SimulationThread(const SimulationThread&) = delete;
  SimulationThread& operator=(const SimulationThread&) = delete;

  // What cannot be done now is refused, and the status says so: all but pausing, settings and pressures while
  // the simulation is held, and playing and stepping once it has stopped itself.

  void play();
  void pause();
  /// Pauses, and computes one frame more.
  void step();
  /// Begins anew at the start, with the settings of now; goes on playing if it did. The past is forgotten.
  void reset();
  /// Takes effect with the next frame; at a time that was gone back to a branch begins. Where the simulation
  /// cannot do with them, the status says why, and those of before stay in force: takeSettings() has them.
  void apply(const Settings& settings);
  /// The settings in force where since the last call others were refused, or the run has come to a time that
  /// has its own.
  std::optional<Settings> takeSettings();
  /// Pauses, and goes to the frame nearest to a time of a branch that has been computed. Frames on the way
  /// are not shown, but for the one that it sets out from; a way that is overtaken by another is dropped.
  void goTo(int branch, double time);
  /// Pauses, and goes back one frame; before the first one of a branch, to where it went from.
  void stepBack();
  /// From the next frame on, frames have pressures, or none.
  void watchPressure(bool on);
  /// Frames have the water's surface, the present one too, or none. Where there is no room for it, the status
  /// says so.
  void watchWater(bool on);

  // The state on disk, as `migiwa simulate --save` and `--resume` keep it (core/io/save_file.h). What became
  // of it is in the status; faults leave the simulation as it is.

  /// Writes the state between two frames. `overrides`: those that the scene was read with, for people to see.
  void saveState(std::filesystem::path file, std::vector<Override> overrides);
  /// Goes on from a save of this scene with the settings of now; plays on if it did.
  void loadState(std::filesystem::path file);

  /// No frame begins until release(), whether it plays or not, but for those on the way to a time that was
  /// asked for before. `why`: who holds it and what for, such as "\"What if\" measures".
  void hold(std::string why);
  /// Goes on playing if it did and was not paused since.
  void release();

  /// The state between two frames, to go on from elsewhere. Whoever waits for it waits for the frame that is
  /// being computed and, on the way to another time, for those to that time; std::future_error where the
  /// simulation ends first.
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
  void applyRequests(std::unique_lock<std::mutex>& lock);
  void giveCaptures(std::unique_lock<std::mutex>& lock);
  void applySettings(std::unique_lock<std::mutex>& lock);
  void applySave(std::unique_lock<std::mutex>& lock);
  void applyLoad(std::unique_lock<std::mutex>& lock);
  // With the lock held.
  bool mayAdvance() const;
  bool refuses(const char* request, bool needsGoodState);
  void begin();
  void settle();
  void stop(std::string why);
  /// A place that is asked for: a frame or, without one, a time (s), and so many frames before it.
  struct Goal {
    int branch;
    std::optional<long> frame;
    double time;
    long back = 0;
  };
  template <class Change>
  void ask(const char* request, const Change& change);
  void depart(std::unique_lock<std::mutex>& lock);
  void travelOn(std::unique_lock<std::mutex>& lock);
  bool arrived(const Goal& goal) const;
  void advanceFrame(bool watchPressure);
  void advance(std::unique_lock<std::mutex>& lock);
  void publish(std::unique_lock<std::mutex>& lock);
  std::shared_ptr<const SurfaceMesh> waterOf(const FrameView& frame);

  const int threads_;
  const Pace pace_;
  // Of the simulation's thread alone, once it runs.
  std::unique_ptr<Simulation> simulation_;
  TimeLine line_;
  FrameSnapshot filling_;
  Clock::time_point due_{};
  struct Water;
  std::unique_ptr<Water> water_;

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
  std::optional<Settings> settings_, settled_;
  std::optional<Goal> goal_, travel_;  ///< asked for; being carried out
  bool sooner_ = false;                ///< something was asked for before `goal_`, and is of the place of now
  bool watchPressure_;
  bool watchWater_ = false, hasWater_ = false;  ///< it was asked for; the last frame has it

  std::thread thread_;
};

// The scene that a window shows, while its file is edited: in another program, which the watched files tell,
// or in the window itself. Files are watched, read, parsed, fitted, filled and written on a thread of the
// session's own, one thing after the other; who draws asks, and takes over what is ready. A scene with faults
// changes nothing. No window, no OpenGL.

struct SessionOptions {
  std::vector<Override> overrides;  ///< --set, over whatever the file says
  int threads = 0;
  Pace pace = Pace::realTime;
  std::size_t past = TimeLine::kLimit;  ///< bytes for the states of the time line
};

/// What is to be saved, and as what.
struct SaveRequest {
  std::string name;  ///< of a file in the scene's folder; ".json" is added where it lacks
  std::string text;
  Settings settings;  ///< as they are now
  ViewState view;     ///< as it is now
};

/// A fault, and the line of the text, from 1, that it is in; 0: elsewhere.
struct TextFault : Fault {
  int line = 0;
};

/// What became of a change.
struct SceneChange {
  enum class Source { file, text, save };  ///< the watched files, apply(), saveAs()
  Source source = Source::file;
  int request = 0;                ///< the number of whoever asked for it; 0: the watched files
  std::vector<TextFault> faults;  ///< none: the scene is valid
  std::optional<Scene> scene;     ///< the valid one
  /// The new scene's simulation at its start; null when the one that runs can take the change over.
  std::unique_ptr<SimulationThread> simulation;
  std::optional<std::string> fileText;  ///< what the scene's file holds now, if that is new
  std::optional<SaveRequest> saved;     ///< the request, when it was carried out

  bool fromFile() const { return source == Source::file; }
};

class SceneSession {
 public:
  /// `scene`: as read from its file. Reads the files.
  SceneSession(const Scene& scene, SessionOptions options);
  /// Waits for what is being read; what is still to be saved is saved.
  ~SceneSession();
  SceneSession(const SceneSession&) = delete;
  SceneSession& operator=(const SceneSession&) = delete;

  // None of these waits for a file, or for a frame of a simulation.

  /// Has the files looked at, and says what became of a change once that is known; from then on the session's
  /// file is that of the change.
  std::optional<SceneChange> poll();
  /// Takes a text in place of the file's; poll() tells what became of it, with that number.
  void apply(std::string text, int number = 0);
  /// Writes the text, with settings and view, into the scene's folder, and goes on with that file. poll()
  /// tells what became of it: with faults in the text or the name nothing is written.
  void saveAs(SaveRequest request, int number = 0);
  /// Ends a simulation that is no longer needed, when its frame is done.
  void retire(std::unique_ptr<SimulationThread> simulation);

  /// Until poll() has something to say about what was begun, and the files have been looked at.
  void wait();
  /// What is being done about a change that takes long, as PreparationStatus says it.
  std::string preparing() const { return preparing_.text(); }

  const std::filesystem::path& file() const { return file_; }
  /// Beside the scene's file: where its state is kept.
  std::filesystem::path stateFile() const;
  const std::vector<Override>& overrides() const { return overrides_; }
  /// What the file held when it was last read or written; empty if it could not be read.
  const std::string& fileText() const { return fileText_; }

 private:
  using Files = std::vector<std::filesystem::path>;
  struct Request {
    SceneChange::Source source = SceneChange::Source::file;
    std::string text;                 ///< to be applied
    std::optional<SaveRequest> save;  ///< to be saved
    int number = 0;
  };
  struct Answer {
    SceneChange change;
    std::filesystem::path file;  ///< the session's from now on
    std::vector<Override> overrides;
  };

  void ask(Request request);

  // On the session's thread.
  void work();
  bool look();
  /// `last`: what is written need not be read again.
  Answer applyRequest(Request request, bool last);
  /// Writes what is requested, and returns the text that was written.
  std::string write(const SaveRequest& request);
  void read(const std::string& text, SceneChange& change, Files& named);

  // Of who asks.
  std::filesystem::path file_;
  std::vector<Override> overrides_;
  std::string fileText_;
  std::vector<std::future<void>> retiring_;

  // Of the session's thread alone, once it runs.
  struct Reader {
    std::filesystem::path file;
    SessionOptions options;
    std::string start;  ///< of the simulation that runs, as startOf() says
    SceneWatch watch;
  };
  Reader reader_;

  std::mutex mutex_;
  std::condition_variable wake_, idle_;
  std::deque<Request> requests_;
  std::deque<Answer> answers_;
  bool look_ = false, busy_ = false, quit_ = false;
  PreparationStatus preparing_;

  std::thread thread_;
};

// Between the "What if" panel, the simulation that runs, and the copy that tries settings in the background.

class WhatIfSession {
 public:
  /// `threads` as for a Simulation.
  explicit WhatIfSession(int threads) : threads_(threads) {}

  /// Begins what the panel asks for and takes in what is done; returns whether something is new to be seen.
  /// The simulation waits meanwhile, so that the times are those of a machine that does nothing else, and
  /// then plays on if it did, unless it was paused in between.
  bool poll(WhatIfModel& model, SimulationThread& simulation, const Settings& now);
  /// Forgets what was tried, and lets the simulation go: another scene takes its place. What is under way is
  /// dropped when it is done.
  void forget(WhatIfModel& model, SimulationThread& simulation);
  /// Waits for what is under way.
  void wait() const;

 private:
  /// What lasts from one question to the next: the copy, whose walls take long to prepare, and the moment
  /// that all points are of.
  struct Outcome {
    std::shared_ptr<WhatIf> copy;
    std::shared_ptr<const StateImage> moment;
    double time = 0;  ///< of the moment (s)
    int frames = 0;   ///< that it went on for
    std::vector<WhatIfPoint> points;
    std::string fault;
  };
  void begin(WhatIfModel& model, SimulationThread& simulation, const Settings& now);

  int threads_;
  std::shared_ptr<WhatIf> copy_;
  std::shared_ptr<const StateImage> moment_;  ///< none: the next question is of that of now
  std::future<Outcome> asking_;
  bool dropped_ = false;
  bool holds_ = false;  ///< the simulation waits
};

}  // namespace migiwa
