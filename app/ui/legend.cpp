#include "app/ui/legend.h"

#include <algorithm>
#include <cmath>

#include "app/ui/number_text.h"
#include "app/ui/theme.h"

namespace migiwa {
namespace {

void drawMap(ImDrawList* draw, const ColorMap& colors, ImVec2 corner, float width, float height) {
  // One column a pixel: the map is shown as it is, without another interpolation on top.
  const int columns = static_cast<int>(width);
  for (int i = 0; i < columns; ++i) {
    const int entry =
        static_cast<int>(std::lround((kColorMapSize - 1) * static_cast<double>(i) / (columns - 1)));
    const Rgb8& c = colors[static_cast<std::size_t>(entry)];
    const float x = corner.x + static_cast<float>(i);
    draw->AddRectFilled({x, corner.y}, {x + 1, corner.y + height}, IM_COL32(c[0], c[1], c[2], 255));
  }
}

/// Lengths (pixels) that follow from the size of the text.
struct Layout {
  float size, margin, padding, barHeight, line, tickLength;

  explicit Layout(const Fonts& fonts)
      : size(fonts.regular->FontSize),
        margin(std::round(0.6F * size)),
        padding(std::round(0.7F * size)),
        barHeight(std::round(0.8F * size)),
        line(std::round(1.4F * size)),
        tickLength(std::round(0.3F * size)) {}
  float height() const { return line + barHeight + tickLength + line + std::round(0.9F * padding); }
};

}  // namespace

int legendHeight(const Fonts& fonts) {
  const Layout layout(fonts);
  return static_cast<int>(layout.height() + layout.margin);
}

void drawLegend(const ColorFieldInfo& field, const std::array<double, 2>& range, const ColorMap& colors,
                const Rect& area, const Fonts& fonts) {
  const auto [size, margin, padding, barHeight, line, tickLength] = Layout(fonts);
  const float room = static_cast<float>(area.width) - 2 * (margin + padding);
  const float barWidth = std::floor(std::min(17 * size, room));
  if (barWidth < 4 * size) return;

  const ImVec2 end{static_cast<float>(area.x + area.width) - margin,
                   static_cast<float>(area.y + area.height) - margin};
  const ImVec2 corner{end.x - barWidth - 2 * padding, end.y - Layout(fonts).height()};
  ImDrawList* draw = ImGui::GetBackgroundDrawList();
  draw->AddRectFilled(corner, end, theme::kPaper, 0.35F * size);
  draw->AddRect(corner, end, theme::kPaperEdge, 0.35F * size);

  const ImVec2 bar{corner.x + padding, corner.y + std::round(0.45F * padding) + line};
  const std::string label = field.label + (field.unit.empty() ? "" : "  (" + field.unit + ")");
  draw->AddText(fonts.regular, size, {bar.x, bar.y - line + 1}, theme::kInk, label.c_str());
  drawMap(draw, colors, bar, barWidth, barHeight);

  const Ticks ticks = roundTicks(range[0], range[1], 6);
  const std::string format = "%." + std::to_string(ticks.decimals) + "f";
  for (const double value : ticks.values) {
    const double share = (value - range[0]) / (range[1] - range[0]);
    const float x = std::floor(bar.x + static_cast<float>(share) * (barWidth - 1));
    draw->AddRectFilled({x, bar.y + barHeight}, {x + 1, bar.y + barHeight + tickLength}, theme::kFaintInk);
    const std::string text = formatNumber(format.c_str(), value);
    const float width = fonts.regular->CalcTextSizeA(size, 1e6F, 0, text.c_str()).x;
    const float left = std::clamp(x - 0.5F * width, corner.x + 2, end.x - width - 2);
    draw->AddText(fonts.regular, size, {std::round(left), bar.y + barHeight + tickLength}, theme::kInk,
                  text.c_str());
  }
}

}  // namespace migiwa
