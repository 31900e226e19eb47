#include <algorithm>
#include <cmath>

#include "app/ui/energy_plot.h"
#include "app/ui/number_text.h"
#include "app/ui/panels.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"

namespace migiwa {
namespace {

/// A row in the colour of its curve.
void energyRow(const char* label, ImU32 color, double value) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  rowLabel(label);
  ImGui::PopStyleColor();
  ImGui::TextUnformatted(formatNumber("%.4g J/kg", value).c_str());
}

}  // namespace

void energyPanel(PanelModel& model) {
  if (model.frame.energy.empty()) return;
  const EnergySample& now = model.frame.energy.back();
  const double start = model.frame.energy.front().source;
  energyRow("Given", theme::kAlert, now.source - start);
  energyRow("Kinetic", theme::kMotion, now.kinetic);
  energyRow("With potential", theme::kAccent, now.kinetic + now.potential - start);
  faintText("From the start, over the mass");
  energyPlot(model.frame.energy, std::floor(7 * ImGui::GetFontSize()));
}

}  // namespace migiwa
