// The window's loop: input in, wishes to the simulation's thread, one frame out.
#pragma once

#include <functional>
#include <optional>

#include "app/render/image.h"
#include "app/ui/panel_model.h"
#include "core/scene/scene_reader.h"

namespace migiwa {

class Viewer;

/// What the window shows at this moment.
struct DrawnFrame {
  const FrameView& frame;
  const RunStatus& run;
  const Viewer& viewer;
};

struct WindowOptions {
  int threads = 0;
  std::vector<Override> overrides;  ///< of the scene, for when its file is read again
  bool playing = true;              ///< start at once
  std::optional<long> frames;       ///< close after so many drawn frames
  /// Keeps a picture that the user asked for; called on a thread of its own, for one picture after the other.
  std::function<void(const Image&)> savePicture;
  /// Told of each frame that has been drawn, on the window's thread.
  std::function<void(const DrawnFrame&)> drawn{};
};

/// Opens a window on the scene and returns when it is closed. Throws MissingError where there is no display.
void runWindow(const Scene& scene, const WindowOptions& options);

}  // namespace migiwa
