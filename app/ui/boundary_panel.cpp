#include "app/ui/panels.h"
#include "app/ui/widgets.h"
#include "core/boundary/handling.h"

namespace migiwa {

void boundaryPanel(PanelModel& model) {
  BoundaryParameters& boundary = model.settings.boundary;
  rowLabel("Walls");
  auto handling = static_cast<int>(boundary.handling);
  if (choice("##handling", handling, handlingNames())) {
    boundary.handling = static_cast<BoundaryHandling>(handling);
    model.wishes.settings = true;
  }
  ImGui::BeginDisabled(boundary.handling != BoundaryHandling::gamma);
  rowLabel("Method of γ");
  if (choice("##method", boundary.gammaMethod, gammaMethodNames())) model.wishes.settings = true;
  ImGui::EndDisabled();
  rowLabel("In use");
  ImGui::TextUnformatted(model.frame.handling.c_str());
}

}  // namespace migiwa
