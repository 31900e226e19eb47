#include "app/ui/what_if_panel.h"

#include <cmath>

#include "app/ui/cost_chart.h"
#include "app/ui/number_text.h"
#include "app/ui/panels.h"
#include "app/ui/settings_rows.h"
#include "app/ui/widgets.h"

namespace migiwa {
namespace {

/// Apart from the rows of the run's own settings, which have the same names.
bool form(Settings& asked) {
  ImGui::PushID("what_if");
  bool changed = wallRows(asked.boundary);
  changed |= maxIterationsRow(asked.solver);
  changed |= toleranceRow(asked.solver);
  ImGui::PopID();
  return changed;
}

std::string percent(const std::optional<double>& share) {
  return share ? formatNumber("%.2f %%", 100 * *share) : "-";
}

}  // namespace

void whatIfPanel(PanelModel& model) {
  WhatIfModel& whatIf = *model.whatIf;
  if (whatIf.follows) whatIf.asked = model.settings;
  if (form(whatIf.asked)) whatIf.follows = false;

  const float width = buttonWidth(2);
  ImGui::BeginDisabled(whatIf.busy);
  if (ImGui::Button(whatIf.points.empty() ? "Measure" : "Try", {width, 0})) whatIf.ask = true;
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(whatIf.points.empty() || whatIf.busy);
  if (ImGui::Button("Clear", {width, 0})) whatIf.clear = true;
  ImGui::EndDisabled();
  faintText(!whatIf.note.empty() ? whatIf.note : "The state of now, five frames on, on a copy");
  if (whatIf.points.empty()) return;

  costChart(whatIf.points, std::floor(11 * ImGui::GetFontSize()));
  for (std::size_t k = 0; k < whatIf.points.size(); ++k) {
    const WhatIfPoint& point = whatIf.points[k];
    ImGui::TextWrapped("%zu  %s", k + 1, point.label.c_str());
    if (!point.trouble.empty()) {
      faintText("    stopped: " + point.trouble);
      continue;
    }
    faintText("    " + formatNumber("%.1f iterations", point.iterations) + ", ρ off by " +
              percent(point.densityError) + ", γ by " + percent(point.gammaError));
  }
}

}  // namespace migiwa
