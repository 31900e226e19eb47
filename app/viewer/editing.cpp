#include "app/viewer/editing.h"

#include <utility>

#include "core/scene/scene_edit.h"

namespace migiwa {
namespace {

/// Messages say the place again where it is not a line of the text.
void listFaults(const std::vector<Fault>& faults, const SceneSession& session, SceneEditor& editor,
                const std::string& text) {
  editor.faults.clear();
  for (const Fault& fault : faults) {
    const int line = lineOfFault(fault, text, session.file());
    const std::string own = session.file().string() + ":";
    std::string message = fault.text();
    if (line > 0 && message.starts_with(own)) message.erase(0, own.size());
    editor.faults.push_back({line, std::move(message)});
  }
}

std::string counted(std::size_t faults) {
  return faults == 1 ? "1 fault" : std::to_string(faults) + " faults";
}

}  // namespace

SceneEditor makeEditor(const SceneSession& session) {
  SceneEditor editor;
  editor.fileName = editor.saveName = session.file().filename().string();
  editor.text = editor.known = session.fileText();
  return editor;
}

void tellEditor(const SceneChange& change, const SceneSession& session, SceneEditor& editor) {
  if (change.fromFile) {
    const bool edited = editor.edited();
    editor.known = session.fileText();
    if (!edited) editor.replaceText(editor.known);
  }
  listFaults(change.faults, session, editor, change.fromFile ? editor.known : editor.text);
  const std::string source = change.fromFile ? editor.fileName + " has changed: " : "";
  if (!change.faults.empty()) {
    editor.note = source + counted(change.faults.size()) + ", the scene before it goes on";
  } else {
    editor.note = source + (change.simulation ? "taken over from the start" : "taken over");
  }
}

void carryOut(SceneEditor& editor, SceneSession& session, const Settings& settings, const ViewState& view) {
  if (std::exchange(editor.apply, false)) {
    editor.note = "reading ...";
    session.apply(editor.text);
  }
  if (std::exchange(editor.revert, false)) {
    editor.known = session.fileText();
    editor.replaceText(editor.known);
    editor.note = "reading ...";
    session.apply(editor.text);
  }
  if (std::exchange(editor.save, false)) {
    try {
      editor.known = session.saveAs(editor.saveName, editor.text, settings, view);
      editor.replaceText(editor.known);
      editor.fileName = editor.saveName = session.file().filename().string();
      editor.faults.clear();
      editor.note = "saved as " + session.file().string();
    } catch (const InputError& error) {
      listFaults(error.faults(), session, editor, editor.text);
      editor.note = "not saved: " + counted(error.faults().size());
    }
  }
}

void keepState(const Wishes& wishes, const SceneSession& session, SimulationThread& simulation) {
  if (wishes.saveState) simulation.saveState(session.stateFile(), session.overrides());
  if (wishes.loadState) simulation.loadState(session.stateFile());
}

void takeOver(SceneChange& change, Viewer& viewer, std::unique_ptr<SimulationThread>& simulation) {
  if (!change.simulation) {
    viewer.replaceScene(*change.scene, std::nullopt);
    return simulation->apply(viewer.settings());
  }
  const bool playing = simulation->status().playing;
  simulation = std::move(change.simulation);
  viewer.replaceScene(simulation->scene(), simulation->walls());
  if (playing) simulation->play();
}

}  // namespace migiwa
