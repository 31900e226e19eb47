#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace migiwa {

void viewPanel(PanelModel& model) {
  ViewState& view = model.view;
  rowLabel("Colour");
  int color = static_cast<int>(view.color);
  if (choice("##color", color, kColorFieldNames)) view.color = static_cast<ColorField>(color);

  const auto along = [](Axis axis) { return static_cast<Eigen::Index>(axis); };
  rowLabel("Cut");
  ImGui::Checkbox("##cut", &view.clip.enabled);
  ImGui::BeginDisabled(!view.clip.enabled);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(3.2F * ImGui::GetFontSize());
  int axis = static_cast<int>(view.clip.axis);
  if (choice("##axis", axis, kAxisNames)) {
    view.clip.axis = static_cast<Axis>(axis);
    view.clip.at = model.bounds.center()[along(view.clip.axis)];
  }
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::Checkbox("Walls", &view.walls);

  rowLabel("Cut at");
  ImGui::BeginDisabled(!view.clip.enabled);
  const double low = model.bounds.min[along(view.clip.axis)], high = model.bounds.max[along(view.clip.axis)];
  ImGui::SliderScalar("##at", ImGuiDataType_Double, &view.clip.at, &low, &high, "%.3f m");
  ImGui::EndDisabled();

  if (model.hasNodes) {
    rowLabel("Nodes");
    ImGui::Checkbox("##nodes", &view.nodes);
    ImGui::SameLine();
    faintText("the balls of SLIM walls");
  }

  const float width = buttonWidth(2);
  if (ImGui::Button("Reset camera", {width, 0})) view.camera = model.scene.view.camera;
  ImGui::SameLine();
  if (ImGui::Button("Save picture", {width, 0})) model.wishes.savePicture = true;
}

}  // namespace migiwa
