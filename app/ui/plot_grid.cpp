#include "app/ui/plot_grid.h"

#include "app/ui/theme.h"

namespace migiwa {

void gridLine(ImDrawList* draw, float left, float right, float y, const std::string& label) {
  const float size = ImGui::GetFontSize(), width = ImGui::CalcTextSize(label.c_str()).x;
  draw->AddLine({left, y}, {right, y}, theme::kGridLine);
  draw->AddText({left - 0.4F * size - width, y - 0.5F * size - 1}, ImGui::GetColorU32(ImGuiCol_TextDisabled),
                label.c_str());
}

}  // namespace migiwa
