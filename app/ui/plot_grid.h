// What the panels' plots have in common.
#pragma once

#include <string>

#include <imgui.h>

namespace migiwa {

/// A grid line at the height y from `left` to `right` (pixels), with its label to the left of it.
void gridLine(ImDrawList* draw, float left, float right, float y, const std::string& label);

}  // namespace migiwa
