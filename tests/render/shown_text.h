// The text in the panels, read back from what is drawn.
#pragma once

#include <string>

namespace migiwa {

/// All text of the last frame's panels, caption and legend: the letters whose rectangles the frame draws, in
/// their order, with a space wherever two do not adjoin. A Viewer must have drawn.
std::string shownText();

}  // namespace migiwa
