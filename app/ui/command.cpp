// "Copy as command": the command line, to be read and copied.
#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "app/ui/widgets.h"

namespace migiwa {

void commandWindow(CommandModel& model, const Rect& area, const Fonts& fonts) {
  if (model.copy) ImGui::SetClipboardText(model.text.c_str());
  model.copy = false;
  if (!model.open) return;
  const float text = ImGui::GetFontSize(), margin = std::round(0.8F * text);
  ImGui::SetNextWindowPos(
      {static_cast<float>(area.x) + margin, static_cast<float>(area.y + area.height) - margin},
      ImGuiCond_Always, {0, 1});
  // Leaves room for the legend.
  const float width = std::max(static_cast<float>(area.width) - 20 * text - 2 * margin, 20 * text);
  ImGui::SetNextWindowSize({width, 0});
  const ImVec4 bar = ImGui::GetStyleColorVec4(ImGuiCol_Header);
  ImGui::PushStyleColor(ImGuiCol_TitleBg, bar);
  ImGui::PushStyleColor(ImGuiCol_TitleBgActive, bar);
  if (ImGui::Begin("What is seen, as a command###command", &model.open,
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                       ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing)) {
    ImGui::PushFont(fonts.mono);
    ImGui::TextWrapped("%s", model.text.c_str());
    ImGui::PopFont();
    ImGui::PushStyleColor(ImGuiCol_Text, theme::alert());
    for (const std::string& line : model.lacks) ImGui::TextWrapped("%s", line.c_str());
    ImGui::PopStyleColor();
    if (ImGui::Button("Copy again")) model.copy = true;
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::PushTextWrapPos(0);
    faintText("It is on the clipboard, and draws this picture without a window.");
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
  ImGui::PopStyleColor(2);
}

}  // namespace migiwa
