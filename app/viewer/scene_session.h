// The scene that a window shows, while its file is edited: in another program, which the watched files tell,
// or in the window itself. A scene is read, and filled where it has to begin anew, on a thread of its own;
// one with faults changes nothing. No window, no OpenGL.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
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

/// What became of a change.
struct SceneChange {
  std::vector<Fault> faults;   ///< none: the scene is valid
  std::optional<Scene> scene;  ///< the valid one
  bool fromFile = false;       ///< else from apply()
  /// The new scene's simulation at its start; null when the one that runs can take the change over.
  std::unique_ptr<SimulationThread> simulation;
};

class SceneSession {
 public:
  /// `scene`: as read from its file.
  SceneSession(const Scene& scene, SessionOptions options);

  /// Looks at the files, and says what became of a change once that is known.
  std::optional<SceneChange> poll();
  /// Takes a text in place of the file's; poll() tells what became of it.
  void apply(std::string text);
  /// Until poll() has something to say about what was begun.
  void wait();

  /// Writes `text`, with settings and view as they are now, as `name` in the scene's folder, and goes on with
  /// that file. Returns what was written. Throws InputError, and writes nothing, when `text` has faults or
  /// the name has.
  std::string saveAs(const std::string& name, const std::string& text, const Settings& settings,
                     const ViewState& view);

  const std::filesystem::path& file() const { return file_; }
  /// Beside the scene's file: where its state is kept.
  std::filesystem::path stateFile() const;
  const std::vector<Override>& overrides() const { return options_.overrides; }
  /// What the file holds; empty if it cannot be read.
  std::string fileText() const;

 private:
  struct Reading {
    SceneChange change;
    std::string start;  ///< of the scene, as startOf() says
    std::vector<std::filesystem::path> files;
  };

  void begin(std::optional<std::string> text);

  std::filesystem::path file_;
  SessionOptions options_;
  std::string start_;  ///< of the simulation that runs
  SceneWatch watch_;
  std::future<Reading> reading_;
  std::optional<std::optional<std::string>> next_;  ///< what to read after that: a text, or the file
};

}  // namespace migiwa
