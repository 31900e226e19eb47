// "Copy as command": the command line that reproduces, without a window, what one shows. No window, no
// OpenGL.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/session/ui_state.h"
#include "core/scene/scene_file.h"

namespace migiwa {

/// What a window shows.
struct ShownMoment {
  const Scene& scene;                      ///< as it was read
  std::filesystem::path file;              ///< as it was named
  const std::vector<Override>& overrides;  ///< with which it was read
  bool saved = true;                       ///< the scene is what the file holds
  const TimeLineView& line;
  const Settings& settings;
  const ViewState& view;
  int width = 0, height = 0;  ///< of the part of the window that shows the scene (pixels)
  double stretch = 1;         ///< of what it shows, over what the camera's field of view has in that height
  double scale = 1;           ///< of its text
  bool inspects = false;      ///< a particle is looked into
};

/// A word as a POSIX shell takes it, in quotes where it needs some.
std::string shellWord(std::string_view word);
/// `migiwa render ...`, and what of the window it does not show.
CommandModel commandFor(const ShownMoment& shown);

}  // namespace migiwa
