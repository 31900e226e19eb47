// The text in the panels, read back from what is drawn, and where the widgets are that bear it: for whoever
// presses widgets by their names.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace migiwa {

/// All text of the last frame's panels, caption and legend: the letters whose rectangles the frame draws, in
/// their order, with a space wherever two do not adjoin; what is not ASCII is a question mark. A Ui must have
/// drawn.
std::string shownText();
/// Where words of it are, about their middle (pixels): the first that stand alone, or those that lie
/// uppermost, as in a list that is open. Nothing where none do.
/// `panel`: the title of the one in which they are to be; empty: anywhere.
std::optional<std::array<float, 2>> placeOfText(const std::string& words, bool uppermost = false,
                                                const std::string& panel = {});
/// Where to press the widget of that name: of a row with that label a share of the widget's width, the middle
/// without one; else the words. Nothing where neither is shown.
std::optional<std::array<float, 2>> placeOfWidget(const std::string& name, std::optional<double> share = {},
                                                  const std::string& panel = {});
/// Titles of the panels that are open.
std::vector<std::string> openPanels();
/// Of what is shown, labels and words, the likest to a name, best first, at most so many.
std::vector<std::string> namesLike(const std::string& name, std::size_t most);

}  // namespace migiwa
