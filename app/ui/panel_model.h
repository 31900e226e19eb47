// What panels show and change. They change the view directly, and the simulation only by asking: whoever owns
// it carries the wishes out between two steps.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/simulation/frame_view.h"
#include "core/simulation/simulation.h"

namespace migiwa {

struct SceneEditor;
struct WhatIfModel;
class StageHistory;

/// How the simulation is doing, apart from its frame.
struct RunStatus {
  bool playing = false;     ///< or would, if nothing held it
  bool stopped = false;     ///< it stopped itself and cannot go on
  std::string trouble;      ///< why
  std::string heldFor{};    ///< why no frame begins though it may play; empty: nothing holds it
  std::string refused{};    ///< one line on the last wish, if it could not be carried out
  std::string stateNote{};  ///< one line on what became of the last wish to save or load the state
  std::vector<std::string> stateFaults{};  ///< why it was not done; empty when it was
  /// Why the last change of settings was refused, and those of before stay; empty when it was taken over,
  /// or after a reset.
  std::vector<std::string> settingsFaults{};
};

/// How the scene is looked at.
struct ViewState {
  Camera camera;
  ClipPlane clip;
  ColorField color = ColorField::density;
  bool walls = true;
  bool nodes = false;  ///< of SLIM walls, in place of their surfaces
  bool panels = true;
};

/// What the user asked for in one frame.
struct Wishes {
  bool play = false, pause = false, step = false, reset = false;
  bool settings = false;  ///< the settings were changed
  bool savePicture = false;
  bool saveState = false, loadState = false;
};

struct PanelModel {
  const FrameInfo& frame;
  const RunStatus& run;
  bool timings;  ///< show wall times, which differ from run to run
  const Scene& scene;
  Bounds bounds;  ///< of the scene (m)
  Settings& settings;
  ViewState& view;
  bool hasNodes;  ///< some wall has nodes to show
  Wishes& wishes;
  SceneEditor* editor;  ///< null: the scene's text is not offered
  WhatIfModel* whatIf;  ///< null: not offered
  const StageHistory& history;
};

}  // namespace migiwa
