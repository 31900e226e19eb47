// The text in the panels, read back from what is drawn.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace migiwa {

/// All text of the last frame's panels, caption and legend: the letters whose rectangles the frame draws, in
/// their order, with a space wherever two do not adjoin. A Viewer must have drawn.
std::string shownText();
/// Where words of it are, about their middle (pixels): the first that stand alone. Nothing where none do.
std::optional<std::array<float, 2>> placeOfText(const std::string& words);

}  // namespace migiwa
