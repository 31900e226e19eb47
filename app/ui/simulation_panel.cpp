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

/// Greyed, and never pressed, while it is not enabled.
bool button(const char* label, float width, bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label, {width, 0});
  ImGui::EndDisabled();
  return pressed;
}

void stateButtons(PanelModel& model) {
  const float width = buttonWidth(2);
  const RunStatus& run = model.run;
  const bool held = !run.heldFor.empty();
  if (button("Save state", width, !run.stopped && !held)) model.wishes.saveState = true;
  ImGui::SameLine();
  if (button("Load state", width, !held)) model.wishes.loadState = true;
  if (run.stateNote.empty()) return;
  if (run.stateFaults.empty()) return faintText(run.stateNote);
  listFaults(run.stateNote, run.stateFaults);
}

}  // namespace

void simulationPanel(PanelModel& model) {
  const float width = buttonWidth(3);
  const RunStatus& run = model.run;
  const bool held = !run.heldFor.empty();
  // Pausing can always be done: what is held then does not go on.
  if (button(run.playing ? "Pause" : "Play", width, !run.stopped && (run.playing || !held))) {
    (run.playing ? model.wishes.pause : model.wishes.play) = true;
  }
  ImGui::SameLine();
  if (button("Step", width, !run.stopped && !held)) model.wishes.step = true;
  ImGui::SameLine();
  if (button("Reset", width, !held)) model.wishes.reset = true;

  rowLabel("Time");
  ImGui::TextUnformatted((formatNumber("%.3f s", model.frame.time) + (held ? ", waits" : "")).c_str());
  if (model.run.stopped) {
    ImGui::PushStyleColor(ImGuiCol_Text, theme::kAlert);
    ImGui::TextWrapped("Stopped: %s", model.run.trouble.c_str());
    ImGui::PopStyleColor();
  }
  if (!model.run.settingsFaults.empty())
    listFaults("Settings not taken over, those of before stay:", model.run.settingsFaults);
  // As with the scene's text: only where there is a file beside which the state can lie.
  if (model.editor != nullptr) stateButtons(model);
  if (run.refused.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, theme::kAlert);
  ImGui::TextWrapped("%s", run.refused.c_str());
  ImGui::PopStyleColor();
}

}  // namespace migiwa
