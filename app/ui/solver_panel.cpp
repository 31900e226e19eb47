#include <algorithm>

#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace migiwa {
namespace {

constexpr ImGuiSliderFlags kClamp = ImGuiSliderFlags_AlwaysClamp;

bool logSlider(const char* id, double& value, double low, double high, const char* format) {
  return ImGui::SliderScalar(id, ImGuiDataType_Double, &value, &low, &high, format,
                             kClamp | ImGuiSliderFlags_Logarithmic);
}

}  // namespace

void solverPanel(PanelModel& model) {
  SolverParameters& solver = model.settings.solver;
  bool& changed = model.wishes.settings;

  rowLabel("Min iterations");
  if (ImGui::SliderInt("##min", &solver.minIterations, 1, 100, "%d", kClamp | ImGuiSliderFlags_Logarithmic)) {
    solver.maxIterations = std::max(solver.maxIterations, solver.minIterations);
    changed = true;
  }
  rowLabel("Max iterations");
  if (ImGui::SliderInt("##max", &solver.maxIterations, 1, 100, "%d", kClamp | ImGuiSliderFlags_Logarithmic)) {
    solver.minIterations = std::min(solver.minIterations, solver.maxIterations);
    changed = true;
  }
  rowLabel("Tolerance");
  if (logSlider("##tolerance", solver.tolerance, 0.0005, 0.2, "%.4f")) changed = true;
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
