// Between the panels, the scene's file and what lies beside it, and the simulation that runs.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/session/session.h"
#include "app/viewer/viewer.h"

namespace migiwa {
namespace {

/// Messages say the place again where it is not a line of the text.
void listFaults(const std::vector<TextFault>& faults, const SceneSession& session, SceneEditor& editor) {
  editor.faults.clear();
  const std::string own = session.file().string() + ":";
  for (const TextFault& fault : faults) {
    std::string message = fault.text();
    if (fault.line > 0 && message.starts_with(own)) message.erase(0, own.size());
    editor.faults.push_back({fault.line, std::move(message)});
  }
}

std::string counted(std::size_t faults) {
  return faults == 1 ? "1 fault" : std::to_string(faults) + " faults";
}

/// What the file holds now. A text that was changed since stays.
void takeFileText(const std::string& text, bool edited, SceneEditor& editor) {
  editor.known = text;
  if (!edited) editor.replaceText(text);
}

/// What was typed since the request stays.
void takeSaved(const SaveRequest& saved, const SceneSession& session, SceneEditor& editor) {
  takeFileText(session.fileText(), editor.text != saved.text, editor);
  editor.fileName = session.file().filename().string();
  if (editor.saveName == saved.name) editor.saveName = editor.fileName;
}

}  // namespace

SceneEditor makeEditor(const SceneSession& session) {
  SceneEditor editor;
  editor.fileName = editor.saveName = session.file().filename().string();
  editor.text = editor.known = editor.applied = session.fileText();
  return editor;
}

void tellEditor(const SceneChange& change, const SceneSession& session, SceneEditor& editor) {
  if (change.saved) takeSaved(*change.saved, session, editor);
  if (change.fromFile() && change.fileText) takeFileText(*change.fileText, editor.edited(), editor);
  if (change.fromFile() && change.scene) editor.applied = session.fileText();
  listFaults(change.faults, session, editor);
  if (change.source == SceneChange::Source::save && !change.saved) {
    editor.note = "not saved: " + counted(change.faults.size());
    return;
  }
  std::string source;
  if (change.fromFile()) source = editor.fileName + " has changed: ";
  if (change.saved) source = "saved as " + session.file().string() + ", ";
  if (!change.faults.empty()) {
    editor.note = source + counted(change.faults.size()) + ", the scene before it goes on";
  } else {
    editor.note = source + (change.simulation ? "taken over from the start" : "taken over");
  }
}

void applyRequest(SceneEditor& editor, SceneSession& session, const Settings& settings,
                  const ViewState& view) {
  const bool revert = std::exchange(editor.revert, false);
  if (revert) editor.replaceText(editor.known);
  if (std::exchange(editor.apply, false) || revert) {
    editor.note = "reading ...";
    session.apply(editor.text, editor.asked);
  }
  if (const std::optional<std::string> text = std::exchange(editor.restore, std::nullopt)) {
    editor.note = "reading ...";
    session.apply(*text, editor.asked);
  }
  if (std::exchange(editor.save, false)) {
    editor.note = "saving ...";
    session.saveAs({editor.saveName, editor.text, settings, view}, editor.asked);
  }
}

void keepState(const UiCommands& commands, const SceneSession& session, SimulationThread& simulation) {
  if (commands.saveState) simulation.saveState(session.stateFile(), session.overrides());
  if (commands.loadState) simulation.loadState(session.stateFile());
}

void applyChange(SceneChange& change, SceneSession& session, Viewer& viewer,
                 std::unique_ptr<SimulationThread>& simulation) {
  if (!change.scene) return viewer.answerText(change.request);
  if (!change.simulation) {
    viewer.replaceScene(*change.scene, std::nullopt, change.request);
    return simulation->apply(viewer.settings());
  }
  const bool playing = simulation->status().playing;
  session.retire(std::exchange(simulation, std::move(change.simulation)));
  if (viewer.replaceScene(simulation->scene(), simulation->walls(), change.request))
    simulation->apply(viewer.settings());
  if (playing) simulation->play();
}

}  // namespace migiwa
