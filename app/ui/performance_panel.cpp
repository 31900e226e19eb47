#include <algorithm>
#include <cmath>

#include "app/ui/error_plot.h"
#include "app/ui/number_text.h"
#include "app/ui/panels.h"
#include "app/ui/stage_bar.h"
#include "app/ui/stage_history.h"
#include "app/ui/widgets.h"

namespace migiwa {

void performancePanel(PanelModel& model) {
  rowLabel("ms per step");
  ImGui::TextUnformatted(milliseconds(model.frame.stepSeconds, model.timings).c_str());
  stageBar(model.frame.stages, model.timings);
  if (model.timings) {
    faintText("ms a frame, by stage, over the last frames");
    stageChart(model.history, std::floor(4 * ImGui::GetFontSize()));
  }
  faintText("Mean density error by iteration");
  // What is left of the column, within reason.
  const float line = ImGui::GetFontSize();
  const float height = std::clamp(ImGui::GetContentRegionAvail().y, 5.6F * line, 9 * line);
  errorPlot(model.frame.errors, model.settings.solver.tolerance, std::floor(height));
}

}  // namespace migiwa
