// Text and panels over the picture.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/platform/context.h"
#include "app/render/image.h"
#include "app/render/projection.h"
#include "app/session/ui_state.h"
#include "core/base/parallel.h"

namespace migiwa {

// The lines in a corner of every picture: what it shows, and when.

struct Fonts;

struct Caption {
  std::string title;
  std::vector<std::pair<std::string, std::string>> rows;  ///< label and value
};

/// Draws it in the top left corner of `area`.
void drawCaption(const Caption& caption, const Rect& area, const Fonts& fonts);

// Text and panels over the picture, through one ImGui context. The same calls serve a window and an
// off-screen run; all that differs is the input. Draws into the framebuffer that is bound.

class Ui {
 public:
  /// `scale`: size of text and panels relative to that on a picture 720 pixels high.
  /// `clipboard`: with nothing in it text is kept for this Ui alone.
  explicit Ui(double scale, Clipboard clipboard = {});
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  /// The part of a picture that panels, with a time line of so many branches, leave to the scene.
  Rect sceneArea(int width, int height, bool panels, std::size_t branches = 0) const;

  void begin(int width, int height, const InputState& input);
  /// From the next frame on.
  void setTheme(Theme theme);
  void panels(PanelModel& model, int height);
  /// Under the scene, `area`, which left room for it.
  void timeLine(PanelModel& model, const Rect& area) const;
  void sceneEditor(SceneEditor& editor, const Rect& area) const;
  void gallery(GalleryModel& gallery, const Rect& area) const;
  void command(CommandModel& model, const Rect& area) const;
  /// What keys and the mouse do.
  void bindings(bool& open, const Rect& area) const;
  /// The particle that is looked into, over the picture of `area` as `projection` shows it, and its card.
  /// `origin`: what positions are relative to (m).
  void inspector(InspectModel& model, const FrameInfo& frame, const Vec3d& origin,
                 const Projection& projection, const Rect& area) const;
  /// The particles that are selected, over the picture of `area` as `projection` shows it.
  void selection(const SelectionModel& model, const FrameView& frame, const Projection& projection,
                 const Rect& area) const;
  /// The value of the section under the mouse; `origin` as for the inspector.
  void sectionPointer(const SectionModel& model, const ColorFieldInfo& info, const Vec3d& origin) const;
  void caption(const Caption& caption, const Rect& area) const;
  void legend(const ColorFieldInfo& field, const std::array<double, 2>& range, const ColorMap& colors,
              const Rect& area) const;
  /// Of a legend and the margin below it (pixels).
  int legendHeight() const;
  /// Ends the frame and draws it, or only lays it out.
  void end(bool draw);

  /// Whether a widget is being held or typed into.
  bool busy() const;
  /// Whether mouse and keyboard belong to a panel in this frame.
  bool wantsMouse() const;
  bool wantsKeyboard() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Where the time of the last frames went: stages stacked over time.

class StageHistory {
 public:
  static constexpr std::size_t kFrames = 240;

  /// Takes in a frame; one that has been taken in before (`steps` as before) counts once.
  void add(long steps, const StageTimes& times);
  const std::deque<StageTimes>& frames() const { return frames_; }

 private:
  std::deque<StageTimes> frames_;
  long steps_ = -1;
};

/// Milliseconds a frame over the last frames, in the colours of the stage bar. Fills the width of the current
/// ImGui window.
void stageChart(const StageHistory& history, float height);

}  // namespace migiwa
