// Text and panels over the picture, through one ImGui context. The same calls serve a window and an
// off-screen run; all that differs is the input. Draws into the framebuffer that is bound.
#pragma once

#include <memory>
#include <string>

#include "app/platform/input_state.h"
#include "app/render/color_map.h"
#include "app/render/projection.h"
#include "app/ui/caption.h"
#include "app/ui/panel_model.h"

namespace migiwa {

class Ui {
 public:
  /// `scale`: size of text and panels relative to that on a picture 720 pixels high.
  explicit Ui(double scale);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  /// The part of a picture that panels leave to the scene.
  Rect sceneArea(int width, int height, bool panels) const;

  void begin(int width, int height, const InputState& input);
  void panels(PanelModel& model, int height);
  void sceneEditor(SceneEditor& editor, const Rect& area) const;
  void caption(const Caption& caption, const Rect& area) const;
  void legend(const ColorFieldInfo& field, const std::array<double, 2>& range, const ColorMap& colors,
              const Rect& area) const;
  /// Of a legend and the margin below it (pixels).
  int legendHeight() const;
  /// Ends the frame and draws it, or only lays it out.
  void end(bool draw);

  /// Whether mouse and keyboard belong to a panel in this frame.
  bool wantsMouse() const;
  bool wantsKeyboard() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace migiwa
