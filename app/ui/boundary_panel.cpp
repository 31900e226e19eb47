#include "app/ui/panels.h"
#include "app/ui/settings_rows.h"
#include "app/ui/widgets.h"

namespace migiwa {

void boundaryPanel(PanelModel& model) {
  if (wallRows(model.settings.boundary)) model.wishes.settings = true;
  rowLabel("In use");
  ImGui::TextUnformatted(model.frame.handling.c_str());
}

}  // namespace migiwa
