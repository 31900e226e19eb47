#include "app/ui/settings_rows.h"

#include <algorithm>

#include "app/ui/widgets.h"
#include "core/boundary/handling.h"

namespace migiwa {

bool wallRows(BoundaryParameters& boundary) {
  rowLabel("Walls");
  auto handling = static_cast<int>(boundary.handling);
  bool changed = choice("##handling", handling, handlingNames());
  boundary.handling = static_cast<BoundaryHandling>(handling);
  ImGui::BeginDisabled(boundary.handling != BoundaryHandling::gamma);
  rowLabel("Method of γ");
  changed |= choice("##method", boundary.gammaMethod, steppedGammaMethodNames());
  ImGui::EndDisabled();
  return changed;
}

bool maxIterationsRow(SolverParameters& solver) {
  rowLabel("Max iterations");
  const bool changed = ImGui::SliderInt("##max", &solver.maxIterations, 1, 100, "%d", kLogSlider);
  if (changed) solver.minIterations = std::min(solver.minIterations, solver.maxIterations);
  return changed;
}

bool toleranceRow(SolverParameters& solver) {
  rowLabel("Tolerance");
  return logSlider("##tolerance", solver.tolerance, 0.0005, 0.2, "%.4f");
}

}  // namespace migiwa
