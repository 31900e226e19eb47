// The scene that a window shows, while its file is edited: in another program, which the watched files tell,
// or in the window itself. Files are watched, read, parsed, fitted, filled and written on a thread of the
// session's own, one thing after the other; who draws asks, and takes over what is ready. A scene with faults
// changes nothing. No window, no OpenGL.
#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/ui/panel_model.h"
#include "app/viewer/scene_watch.h"
#include "app/viewer/simulation_thread.h"
#include "core/base/error.h"
#include "core/scene/scene_reader.h"

namespace migiwa {

struct SessionOptions {
  std::vector<Override> overrides;  ///< --set, over whatever the file says
  int threads = 0;
  Pace pace = Pace::realTime;
};

/// What is to be saved, and as what.
struct SaveWish {
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
  std::vector<TextFault> faults;  ///< none: the scene is valid
  std::optional<Scene> scene;     ///< the valid one
  /// The new scene's simulation at its start; null when the one that runs can take the change over.
  std::unique_ptr<SimulationThread> simulation;
  std::optional<std::string> fileText;  ///< what the scene's file holds now, if that is new
  std::optional<SaveWish> saved;        ///< the wish, when it was carried out

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
  /// Takes a text in place of the file's; poll() tells what became of it.
  void apply(std::string text);
  /// Writes the text, with settings and view, into the scene's folder, and goes on with that file. poll()
  /// tells what became of it: with faults in the text or the name nothing is written.
  void saveAs(SaveWish wish);
  /// Ends a simulation that nobody needs any more, when its frame is done.
  void retire(std::unique_ptr<SimulationThread> simulation);

  /// Until poll() has something to say about what was begun, and the files have been looked at.
  void wait();

  const std::filesystem::path& file() const { return file_; }
  /// Beside the scene's file: where its state is kept.
  std::filesystem::path stateFile() const;
  const std::vector<Override>& overrides() const { return overrides_; }
  /// What the file held when it was last read or written; empty if it could not be read.
  const std::string& fileText() const { return fileText_; }

 private:
  using Files = std::vector<std::filesystem::path>;
  struct Wish {
    SceneChange::Source source = SceneChange::Source::file;
    std::string text;              ///< to be applied
    std::optional<SaveWish> save;  ///< to be saved
  };
  struct Answer {
    SceneChange change;
    std::filesystem::path file;  ///< the session's from now on
    std::vector<Override> overrides;
  };

  void ask(Wish wish);

  // On the session's thread.
  void work();
  bool look();
  /// `last`: what is written need not be read again.
  Answer carryOut(Wish wish, bool last);
  /// Writes what is wished for, and returns the text that was written.
  std::string write(const SaveWish& wish);
  void read(std::string text, SceneChange& change, Files& named);

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
  std::deque<Wish> wishes_;
  std::deque<Answer> answers_;
  bool look_ = false, busy_ = false, quit_ = false;

  std::thread thread_;
};

}  // namespace migiwa
