// What the colours mean: name and unit of the quantity, the colour map, and numbers beside it.
#pragma once

#include <array>

#include "app/render/color_map.h"
#include "app/render/projection.h"
#include "app/ui/fonts.h"
#include "core/simulation/frame_view.h"

namespace migiwa {

/// Of a legend and the margin below it (pixels).
int legendHeight(const Fonts& fonts);

/// Draws it in the bottom right corner of `area`.
void drawLegend(const ColorFieldInfo& field, const std::array<double, 2>& range, const ColorMap& colors,
                const Rect& area, const Fonts& fonts);

}  // namespace migiwa
