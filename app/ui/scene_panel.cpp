#include <algorithm>
#include <string>

#include "app/ui/panels.h"
#include "app/ui/scene_editor.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"

namespace migiwa {
namespace {

/// The panels below are not to be pushed out of sight.
constexpr std::size_t kMostListed = 4;

}  // namespace

void scenePanel(PanelModel& model) {
  SceneEditor& editor = *model.editor;
  if (ImGui::Button(editor.open ? "Close editor" : "Edit scene", {buttonWidth(2), 0})) {
    editor.open = !editor.open;
    editor.wantsFocus = editor.open;
  }
  ImGui::SameLine();
  faintText(editor.fileName);
  if (editor.faults.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, theme::kAlert);
  ImGui::TextWrapped("Not taken over, the scene before it goes on:");
  const std::size_t listed = std::min(editor.faults.size(), kMostListed);
  for (std::size_t k = 0; k < listed; ++k) {
    const SceneEditor::Fault& fault = editor.faults[k];
    const std::string place = fault.line > 0 ? "line " + std::to_string(fault.line) + "  " : "";
    ImGui::TextWrapped("%s%s", place.c_str(), fault.message.c_str());
  }
  if (listed < editor.faults.size())
    ImGui::TextWrapped("and %zu more, listed in the editor", editor.faults.size() - listed);
  ImGui::PopStyleColor();
}

}  // namespace migiwa
