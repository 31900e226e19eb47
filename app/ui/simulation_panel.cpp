#include "app/ui/number_text.h"
#include "app/ui/panels.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"

namespace migiwa {

void simulationPanel(PanelModel& model) {
  const float width = buttonWidth(3);
  ImGui::BeginDisabled(model.run.stopped);
  if (ImGui::Button(model.run.playing ? "Pause" : "Play", {width, 0})) {
    (model.run.playing ? model.wishes.pause : model.wishes.play) = true;
  }
  ImGui::SameLine();
  if (ImGui::Button("Step", {width, 0})) model.wishes.step = true;
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (ImGui::Button("Reset", {width, 0})) model.wishes.reset = true;

  rowLabel("Time");
  ImGui::TextUnformatted(formatNumber("%.3f s", model.frame.time).c_str());
  if (model.run.stopped) {
    ImGui::PushStyleColor(ImGuiCol_Text, theme::kAlert);
    ImGui::TextWrapped("Stopped: %s", model.run.trouble.c_str());
    ImGui::PopStyleColor();
  }
}

}  // namespace migiwa
