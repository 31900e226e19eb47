#include "app/ui/panels.h"
#include "app/ui/widgets.h"
#include "core/boundary/gamma_method.h"

namespace migiwa {

void boundaryPanel(PanelModel& model) {
  BoundaryParameters& boundary = model.settings.boundary;
  bool corrected = boundary.handling == BoundaryHandling::gamma;
  rowLabel("Correction γ");
  if (ImGui::Checkbox("##correction", &corrected)) {
    boundary.handling = corrected ? BoundaryHandling::gamma : BoundaryHandling::none;
    model.wishes.settings = true;
  }
  ImGui::SameLine();
  faintText(corrected ? "on" : "off");
  ImGui::BeginDisabled(!corrected);
  rowLabel("Method");
  if (choice("##method", boundary.gammaMethod, gammaMethodNames())) model.wishes.settings = true;
  ImGui::EndDisabled();
  rowLabel("In use");
  ImGui::TextUnformatted(model.frame.handling.c_str());
}

}  // namespace migiwa
