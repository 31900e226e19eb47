// One frame of the program: scene, text and panels, in a window and off-screen alike. Who calls it owns the
// context, which must stay current, and decides when to stop.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/platform/input_state.h"
#include "app/render/image.h"
#include "app/render/renderer.h"
#include "app/ui/stage_history.h"
#include "app/ui/ui.h"

namespace migiwa {

struct ViewerOptions {
  double scale = 1;     ///< size of text and panels; 1 suits a picture 720 pixels high
  bool panels = true;   ///< draw the panels
  bool timings = true;  ///< show wall times, which differ from run to run
  std::string note{};   ///< an extra line for the caption, "label = value"
  ColorMap colors = makeColorMap();
  /// The scene's text, to be edited in the window; null: not offered. Outlives the viewer.
  SceneEditor* editor = nullptr;
  /// Settings to be tried on a copy; null: not offered. Outlives the viewer.
  WhatIfModel* whatIf = nullptr;
};

/// The scale that suits a picture of this size.
double scaleFor(int width, int height);

class Viewer {
 public:
  Viewer(const Scene& scene, WallDrawing walls, const ViewerOptions& options);

  /// Takes over a changed scene. The camera and what else a person has turned stay, unless the scene's own
  /// view has changed. `walls`: of a scene that begins anew; nothing: the same ones, only parameters changed.
  void replaceScene(const Scene& scene, std::optional<WallDrawing> walls);

  /// Draws one frame and returns what the user asked for.
  Wishes frame(const FrameView& frame, const RunStatus& run, const InputState& input, int width, int height);
  /// The picture of the last frame.
  Image picture() const { return target_->read(); }
  /// Draws a frame that nobody sees or touches; it depends on no earlier one.
  Image takePicture(const FrameView& view, const RunStatus& run, int width, int height);
  void copyToWindow() const { target_->copyToWindow(target_->width(), target_->height()); }

  const Settings& settings() const { return settings_; }
  /// Shows these from now on: those that the panels asked for were refused.
  void setSettings(const Settings& settings) { settings_ = settings; }
  ViewState& view() { return view_; }
  ColorFieldInfo colorInfo(ColorField field) const {
    return colorFieldInfo(field, referenceSpeed_, scene_.solver.restDensity);
  }
  /// Ends of the colour map for a field, in its unit.
  std::array<double, 2> colorRange(ColorField field) const;

 private:
  Wishes drawUi(const FrameView& frame, const RunStatus& run, const Rect& area);
  void moveCamera(const InputState& input, const Rect& area);
  void keys(const InputState& input, const RunStatus& run, Wishes& wishes);
  std::optional<Vec3d> pointAt(int x, int y, const Rect& area) const;
  void takeView();
  Caption caption(const FrameView& frame, const RunStatus& run) const;

  Scene scene_;
  ViewerOptions options_;
  Bounds bounds_;
  double referenceSpeed_;
  Settings settings_;
  ViewState view_;
  Renderer renderer_;
  Ui ui_;
  StageHistory history_;
  std::optional<RenderTarget> target_;
  InputState last_;
  bool laidOut_ = false;
  bool draggingScene_ = false;
  double sinceClick_ = 0;
};

}  // namespace migiwa
