// Between the window, the scene's file and what lies beside it, and the simulation that runs.
#pragma once

#include <memory>

#include "app/ui/scene_editor.h"
#include "app/viewer/scene_session.h"
#include "app/viewer/viewer.h"

namespace migiwa {

/// An editor that holds the session's file.
SceneEditor makeEditor(const SceneSession& session);

/// Faults, or that the change has been taken over. A text that the user has changed stays as it is, whatever
/// happens to the file.
void tellEditor(const SceneChange& change, const SceneSession& session, SceneEditor& editor);

/// Hands what the editor asks for to the session, which carries it out in the background.
void carryOut(SceneEditor& editor, SceneSession& session, const Settings& settings, const ViewState& view);

/// Saves the simulation's state beside the scene's file, or goes on from it.
void keepState(const Wishes& wishes, const SceneSession& session, SimulationThread& simulation);

/// Shows the valid scene of a change: with its new simulation, which plays if the old one did, or by handing
/// its parameters to the one that runs. The old simulation ends in the session's background.
void takeOver(SceneChange& change, SceneSession& session, Viewer& viewer,
              std::unique_ptr<SimulationThread>& simulation);

}  // namespace migiwa
