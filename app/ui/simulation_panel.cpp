#include <algorithm>

#include "app/ui/number_text.h"
#include "app/ui/panels.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"

namespace migiwa {

namespace {

/// What hinders is listed as far as the panels below stay in sight.
constexpr std::size_t kMostListed = 4;

void listFaults(const std::string& title, const std::vector<std::string>& faults) {
  ImGui::PushStyleColor(ImGuiCol_Text, theme::kAlert);
  ImGui::TextWrapped("%s", title.c_str());
  const std::size_t listed = std::min(faults.size(), kMostListed);
  for (std::size_t k = 0; k < listed; ++k) ImGui::TextWrapped("%s", faults[k].c_str());
  if (listed < faults.size()) ImGui::TextWrapped("and %zu more", faults.size() - listed);
  ImGui::PopStyleColor();
}

void stateButtons(PanelModel& model) {
  const float width = buttonWidth(2);
  ImGui::BeginDisabled(model.run.stopped);
  if (ImGui::Button("Save state", {width, 0})) model.wishes.saveState = true;
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (ImGui::Button("Load state", {width, 0})) model.wishes.loadState = true;
  const RunStatus& run = model.run;
  if (run.stateNote.empty()) return;
  if (run.stateFaults.empty()) return faintText(run.stateNote);
  listFaults(run.stateNote, run.stateFaults);
}

}  // namespace

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
  if (!model.run.settingsFaults.empty())
    listFaults("Settings not taken over, those of before stay:", model.run.settingsFaults);
  // As with the scene's text: only where there is a file beside which the state can lie.
  if (model.editor != nullptr) stateButtons(model);
}

}  // namespace migiwa
