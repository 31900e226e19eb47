// What a window shows of one scene, be it on a screen or not: the simulation beside it, its file while it is
// edited, what is worked out in the background, and the frame of all that.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "app/session/probe.h"
#include "app/session/section_session.h"
#include "app/session/session.h"
#include "app/viewer/viewer.h"

namespace migiwa {

class SceneWindow {
 public:
  /// How it is drawn.
  struct Look {
    double scale = 1;  ///< as of a viewer
    bool timings = true;
    Clipboard clipboard{};
  };

  /// `options` outlive it.
  SceneWindow(const Scene& scene, std::unique_ptr<SimulationThread> simulation, const WindowOptions& options,
              const Look& look);
  /// Waits for what is being kept.
  ~SceneWindow();
  SceneWindow(const SceneWindow&) = delete;
  SceneWindow& operator=(const SceneWindow&) = delete;

  enum class News { none, frame, panels };
  /// Takes in what has been done in the background: whether the picture is another, or the panels are, too.
  News poll();
  /// How a frame is drawn that is to be there soon.
  struct Haste {
    double share = 1;  ///< as of a SceneDrawing
    bool keeps =
        false;  ///< a scene that was drawn from the frame before serves, but for another camera or view
  };
  /// Draws a frame.
  void draw(const InputState& input, int width, int height, const Haste& haste);
  void draw(const InputState& input, int width, int height) { draw(input, width, height, Haste{}); }
  /// Does what was asked for in it.
  void carryOut();

  Viewer& viewer() { return viewer_; }
  GalleryModel& gallery() { return gallery_; }
  const CommandModel& command() const { return command_; }
  const SelectionModel& selection() const { return selection_; }
  SimulationThread& simulation() { return *simulation_; }
  /// As of the last frame.
  const RunStatus& run() const { return run_; }
  FrameView frame() const { return frame_.view(); }
  /// Waits for what is being kept, and throws where it could not be.
  void keepAll();
  /// A section or a table is still being made.
  bool busy() const { return sections_.busy() || listing_.valid(); }
  /// What is being done about a change of the scene that takes long.
  std::string preparing() const { return session_.preparing(); }

 private:
  void keepWhatIsAsked();
  void tellCommand();
  void listParticles();

  const WindowOptions& options_;
  std::unique_ptr<SimulationThread> simulation_;
  SceneSession session_;
  SceneEditor editor_;
  WhatIfModel whatIf_;
  WhatIfSession trials_;
  InspectModel inspect_;
  ProbeSession probes_;
  SectionModel section_;
  SectionSession sections_;
  GalleryModel gallery_;
  CommandModel command_;
  SelectionModel selection_;
  Viewer viewer_;
  FrameSnapshot frame_;
  long frames_ = 0, drawn_ = 0;  ///< numbers of the one that was taken last, and of the one that is seen
  RunStatus run_;
  int width_ = 1, height_ = 1;  ///< of it (pixels)
  UiCommands commands_;
  std::future<void> saving_;
  std::future<std::string> listing_;  ///< of particles; what became of it
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
};

}  // namespace migiwa
