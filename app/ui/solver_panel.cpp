#include <algorithm>

#include "app/ui/panels.h"
#include "app/ui/settings_rows.h"
#include "app/ui/widgets.h"

namespace migiwa {

void solverPanel(PanelModel& model) {
  SolverParameters& solver = model.settings.solver;
  bool& changed = model.wishes.settings;

  rowLabel("Min iterations");
  if (ImGui::SliderInt("##min", &solver.minIterations, 1, 100, "%d", kLogSlider)) {
    solver.maxIterations = std::max(solver.maxIterations, solver.minIterations);
    changed = true;
  }
  changed |= maxIterationsRow(solver);
  changed |= toleranceRow(solver);
  rowLabel("Position step");
  int step = static_cast<int>(solver.positionStep);
  if (choice("##position", step, kPositionStepNames)) {
    solver.positionStep = static_cast<PositionStep>(step);
    changed = true;
  }
  rowLabel("Time step");
  double milliseconds = 1e3 * solver.timeStep;
  if (logSlider("##time", milliseconds, 0.5, 20, "%.2f ms")) {
    solver.timeStep = milliseconds / 1e3;
    changed = true;
  }
}

}  // namespace migiwa
