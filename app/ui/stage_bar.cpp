#include "app/ui/stage_bar.h"

#include <array>
#include <cmath>
#include <string>

#include <imgui.h>

#include "app/ui/number_text.h"
#include "app/ui/theme.h"

namespace migiwa {
namespace {

/// Colours that stay apart from their neighbours in the list; more stages than colours begin again.
constexpr std::array<ImU32, 12> kStageColors{
    IM_COL32(77, 170, 214, 255),  IM_COL32(240, 172, 66, 255),  IM_COL32(88, 190, 140, 255),
    IM_COL32(222, 108, 92, 255),  IM_COL32(160, 138, 220, 255), IM_COL32(218, 210, 110, 255),
    IM_COL32(224, 142, 190, 255), IM_COL32(150, 164, 178, 255), IM_COL32(120, 210, 220, 255),
    IM_COL32(196, 140, 100, 255), IM_COL32(170, 200, 110, 255), IM_COL32(120, 130, 230, 255)};

std::string shownName(const std::string& stage) {
  std::string name = stage;
  for (char& c : name)
    if (c == '_') c = ' ';
  return name;
}

}  // namespace

ImU32 stageColor(std::size_t i) {
  return kStageColors[i % kStageColors.size()];
}

void stageBar(const StageTimes& times, bool timings) {
  const std::vector<StageTime>& stages = times.stages();
  double total = 0;
  for (const StageTime& stage : stages) total += stage.seconds;

  ImDrawList* draw = ImGui::GetWindowDrawList();
  const float size = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float height = std::round(0.85F * size);
  draw->AddRectFilled(corner, {corner.x + width, corner.y + height}, theme::kWell, 3);
  if (timings && total > 0) {
    float x = corner.x;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      const float end = x + width * static_cast<float>(stages[i].seconds / total);
      draw->AddRectFilled({x, corner.y}, {end, corner.y + height}, stageColor(i));
      x = end;
    }
  }
  ImGui::Dummy({width, height});

  if (stages.empty() || !ImGui::BeginTable("stages", 2, ImGuiTableFlags_SizingStretchSame)) return;
  const float dot = std::round(0.55F * size);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float cell = ImGui::GetContentRegionAvail().x;
    const float top = std::round(at.y + 0.5F * (size - dot));
    draw->AddRectFilled({at.x, top}, {at.x + dot, top + dot}, stageColor(i), 2);
    ImGui::SetCursorScreenPos({at.x + 1.5F * dot, at.y});
    ImGui::TextUnformatted(shownName(stages[i].name).c_str());
    const std::string text = milliseconds(stages[i].seconds, timings);
    ImGui::SameLine();
    ImGui::SetCursorScreenPos({std::round(at.x + cell - ImGui::CalcTextSize(text.c_str()).x), at.y});
    ImGui::TextUnformatted(text.c_str());
  }
  ImGui::EndTable();
}

}  // namespace migiwa
