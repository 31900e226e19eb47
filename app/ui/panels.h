// The program's panels, one file each. They are drawn one under the other in the current ImGui window.
#pragma once

#include "app/ui/panel_model.h"

namespace migiwa {

/// Needs the model's editor.
void scenePanel(PanelModel& model);
void simulationPanel(PanelModel& model);
void boundaryPanel(PanelModel& model);
void solverPanel(PanelModel& model);
/// Of one effect among the settings'.
void effectPanel(PanelModel& model, NamedEffect& effect);
void viewPanel(PanelModel& model);
/// Needs the model's whatIf.
void whatIfPanel(PanelModel& model);
void performancePanel(PanelModel& model);
/// Energies over the run, against what was given.
void energyPanel(PanelModel& model);

}  // namespace migiwa
