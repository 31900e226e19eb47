#include "app/ui/caption.h"

#include <algorithm>
#include <cmath>

#include "app/ui/fonts.h"
#include "app/ui/theme.h"

namespace migiwa {
namespace {

float textWidth(ImFont* font, const std::string& text) {
  return font->CalcTextSizeA(font->FontSize, 1e6F, 0, text.c_str()).x;
}

}  // namespace

void drawCaption(const Caption& caption, const Rect& area, const Fonts& fonts) {
  const float size = fonts.regular->FontSize;
  const float gap = std::round(0.7F * size), line = std::round(1.32F * size),
              padding = std::round(0.6F * size);
  float labels = 0, values = 0;
  for (const auto& [label, value] : caption.rows) {
    labels = std::max(labels, textWidth(fonts.regular, label));
    values = std::max(values, textWidth(fonts.regular, value));
  }
  const float width = std::max(textWidth(fonts.bold, caption.title), labels + gap + values);
  const auto rows = static_cast<float>(caption.rows.size() + (caption.title.empty() ? 0 : 1));

  ImDrawList* draw = ImGui::GetBackgroundDrawList();
  const ImVec2 corner{static_cast<float>(area.x) + padding, static_cast<float>(area.y) + padding};
  const ImVec2 end{std::ceil(corner.x + width + 2 * padding), corner.y + rows * line + padding};
  draw->AddRectFilled(corner, end, theme::kPaper, 0.35F * size);
  draw->AddRect(corner, end, theme::kPaperEdge, 0.35F * size);
  const float x = corner.x + padding;
  float y = corner.y + std::round(0.5F * padding + 0.5F * (line - size));
  if (!caption.title.empty()) {
    draw->AddText(fonts.bold, size, {x, y}, theme::kInk, caption.title.c_str());
    y += line;
  }
  for (const auto& [label, value] : caption.rows) {
    draw->AddText(fonts.regular, size, {x, y}, theme::kFaintInk, label.c_str());
    draw->AddText(fonts.regular, size, {std::round(x + labels + gap), y}, theme::kInk, value.c_str());
    y += line;
  }
}

}  // namespace migiwa
