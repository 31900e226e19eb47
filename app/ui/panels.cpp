#include <algorithm>
#include <cmath>
#include <string>

#include "app/session/ui_state.h"
#include "app/session/undo.h"
#include "app/ui/ui.h"
#include "app/ui/widgets.h"
#include "core/base/messages.h"

namespace migiwa {

void changesPanel(PanelModel& model) {
  constexpr std::size_t kListed = 6;
  const float width = buttonWidth(2);
  ImGui::BeginDisabled(!model.undo.canUndo());
  if (ImGui::Button("Undo", {width, 0})) model.commands.undo = 1;
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Control and Z");
  ImGui::SameLine();
  ImGui::BeginDisabled(!model.undo.canRedo());
  if (ImGui::Button("Redo", {width, 0})) model.commands.undo = -1;
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Control and Y, or control, shift and Z");
  const std::vector<std::string> done = model.undo.done(), undone = model.undo.undone();
  if (done.empty() && undone.empty()) faintText("None yet");
  // The oldest of those that fit is on top, what was taken back below.
  const std::size_t listed = std::min(done.size(), kListed);
  if (listed < done.size()) faintText(std::to_string(done.size() - listed) + " before these");
  for (std::size_t k = listed; k-- > 0;) {
    ImGui::PushID(static_cast<int>(k));
    if (ImGui::Selectable(done[k].c_str())) model.commands.undo = static_cast<int>(k) + 1;
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s\nA click takes it back, with all that came after it", done[k].c_str());
    ImGui::PopID();
  }
  for (std::size_t k = 0; k < std::min(undone.size(), kListed); ++k) {
    ImGui::PushID(-1 - static_cast<int>(k));
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    if (ImGui::Selectable(undone[k].c_str())) model.commands.undo = -1 - static_cast<int>(k);
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s\nA click does it again", undone[k].c_str());
    ImGui::PopID();
  }
}

void boundaryPanel(PanelModel& model) {
  if (wallRows(model.settings.boundary)) model.commands.settings = true;
  rowLabel("In use");
  ImGui::TextUnformatted(model.frame.handling.c_str());
}

namespace {

/// The panels below are not to be pushed out of sight.
constexpr std::size_t kMostFaultsShown = 4;

}  // namespace

void scenePanel(PanelModel& model) {
  SceneEditor& editor = *model.editor;
  const float width = 5.5F * ImGui::GetFontSize();  // leaves room for the name
  if (ImGui::Button(editor.open ? "Close editor" : "Edit scene", {width, 0})) {
    editor.open = !editor.open;
    editor.wantsFocus = editor.open;
  }
  ImGui::SameLine();
  if (model.gallery != nullptr) {
    if (ImGui::Button("Scenes", {width, 0})) model.gallery->open = !model.gallery->open;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("All shipped scenes, the last opened ones, any other file");
    ImGui::SameLine();
  }
  if (ImGui::Button("?")) model.commands.listKeys = true;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("What keys and the mouse do");
  ImGui::SameLine();
  faintText(fitted(editor.fileName, ImGui::GetContentRegionAvail().x));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", editor.fileName.c_str());
  if (editor.faults.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, theme::alert());
  ImGui::TextWrapped("Not taken over, the scene before it goes on:");
  const std::size_t listed = std::min(editor.faults.size(), kMostFaultsShown);
  for (std::size_t k = 0; k < listed; ++k) {
    const SceneEditor::Fault& fault = editor.faults[k];
    const std::string place = fault.line > 0 ? "line " + std::to_string(fault.line) + "  " : "";
    ImGui::TextWrapped("%s%s", place.c_str(), fault.message.c_str());
  }
  if (listed < editor.faults.size())
    ImGui::TextWrapped("and %zu more, listed in the editor", editor.faults.size() - listed);
  ImGui::PopStyleColor();
}

namespace {

/// What hinders is listed as far as the panels below stay in sight.

void listFaults(const std::string& title, const std::vector<std::string>& faults) {
  ImGui::PushStyleColor(ImGuiCol_Text, theme::alert());
  ImGui::TextWrapped("%s", title.c_str());
  const std::size_t listed = std::min(faults.size(), kMostFaultsShown);
  for (std::size_t k = 0; k < listed; ++k) ImGui::TextWrapped("%s", faults[k].c_str());
  if (listed < faults.size()) ImGui::TextWrapped("and %zu more", faults.size() - listed);
  ImGui::PopStyleColor();
}

/// Greyed, and never pressed, while it is not enabled.
bool button(const char* label, float width, bool enabled) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label, {width, 0});
  ImGui::EndDisabled();
  return pressed;
}

void stateButtons(PanelModel& model) {
  const float width = buttonWidth(2);
  const RunStatus& run = model.run;
  const bool held = !run.heldFor.empty();
  if (button("Save state", width, !run.stopped && !held)) model.commands.saveState = true;
  ImGui::SameLine();
  if (button("Load state", width, !held)) model.commands.loadState = true;
  if (run.stateNote.empty()) return;
  if (run.stateFaults.empty()) return faintText(run.stateNote);
  listFaults(run.stateNote, run.stateFaults);
}

}  // namespace

void simulationPanel(PanelModel& model) {
  const float width = buttonWidth(3);
  const RunStatus& run = model.run;
  const bool held = !run.heldFor.empty();
  // Pausing can always be done: what is held then does not go on.
  if (button(run.playing ? "Pause" : "Play", width, !run.stopped && (run.playing || !held))) {
    (run.playing ? model.commands.pause : model.commands.play) = true;
  }
  ImGui::SameLine();
  if (button("Step", width, !run.stopped && !held)) model.commands.step = true;
  ImGui::SameLine();
  if (button("Reset", width, !held)) model.commands.reset = true;

  rowLabel("Time");
  ImGui::TextUnformatted((formatNumber("%.3f s", model.frame.time) + (held ? ", waits" : "")).c_str());
  if (model.run.stopped) {
    ImGui::PushStyleColor(ImGuiCol_Text, theme::alert());
    ImGui::TextWrapped("Stopped: %s", model.run.trouble.c_str());
    ImGui::PopStyleColor();
  }
  if (!model.run.settingsFaults.empty())
    listFaults("Settings not taken over, those of before stay:", model.run.settingsFaults);
  // As with the scene's text: only where there is a file beside which the state can lie.
  if (model.editor != nullptr) stateButtons(model);
  if (run.refused.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, theme::alert());
  ImGui::TextWrapped("%s", run.refused.c_str());
  ImGui::PopStyleColor();
}

void solverPanel(PanelModel& model) {
  SolverParameters& solver = model.settings.solver;
  bool& changed = model.commands.settings;

  rowLabel("Min iterations");
  if (ImGui::SliderInt("##min", &solver.minIterations, 1, 100, "%d", kLogSlider)) {
    solver.maxIterations = std::max(solver.maxIterations, solver.minIterations);
    changed = true;
  }
  keyHint("/solver/min_iterations");
  changed |= maxIterationsRow(solver);
  changed |= toleranceRow(solver);
  rowLabel("Method");
  int method = static_cast<int>(solver.method);
  if (choice("##method", method, kSolverMethodNames)) {
    solver.takeMethod(static_cast<SolverMethod>(method));
    changed = true;
  }
  keyHint("/solver/method");
  ImGui::BeginDisabled(solver.method != SolverMethod::pbf);
  rowLabel("Velocities");
  int from = static_cast<int>(solver.velocityStep);
  if (choice("##velocities", from, kVelocityStepNames)) {
    solver.takeVelocities(static_cast<VelocityStep>(from));
    changed = true;
  }
  keyHint("/solver/velocity_step");
  rowLabel("Position step");
  int step = static_cast<int>(solver.positionStep);
  if (choice("##position", step, kPositionStepNames)) {
    solver.positionStep = static_cast<PositionStep>(step);
    changed = true;
  }
  keyHint("/solver/position_step");
  ImGui::EndDisabled();
  rowLabel("Time step");
  double milliseconds = 1e3 * solver.timeStep;
  if (logSlider("##time", milliseconds, 0.5, 20, "%.2f ms")) {
    solver.timeStep = milliseconds / 1e3;
    changed = true;
  }
  keyHint("/solver/time_step");
}

void viewPanel(PanelModel& model) {
  ViewState& view = model.view;
  rowLabel("Colour");
  ImGui::BeginDisabled(view.water);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 5.4F * ImGui::GetFontSize());
  int color = static_cast<int>(view.color);
  if (choice("##color", color, kColorFieldNames)) view.color = static_cast<ColorField>(color);
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::Checkbox("Water", &view.water);

  rowLabel("Colours");
  int scale = static_cast<int>(view.scale);
  if (choice("##scale", scale, kColorScaleNames)) view.scale = static_cast<ColorScale>(scale);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("Both grow lighter in equal steps, for colour-blind eyes, too");

  const auto along = [](Axis axis) { return static_cast<Eigen::Index>(axis); };
  rowLabel("Cut");
  ImGui::Checkbox("##cut", &view.clip.enabled);
  ImGui::BeginDisabled(!view.clip.enabled);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(3.2F * ImGui::GetFontSize());
  int axis = static_cast<int>(view.clip.axis);
  if (choice("##axis", axis, kAxisNames)) {
    view.clip.axis = static_cast<Axis>(axis);
    view.clip.at = model.bounds.center()[along(view.clip.axis)];
  }
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::Checkbox("Walls", &view.walls);

  rowLabel("Cut at");
  ImGui::BeginDisabled(!view.clip.enabled);
  const double origin = model.scene.origin[along(view.clip.axis)];
  const double low = origin + model.bounds.min[along(view.clip.axis)],
               high = origin + model.bounds.max[along(view.clip.axis)];
  double at = origin + view.clip.at;
  if (ImGui::SliderScalar("##at", ImGuiDataType_Double, &at, &low, &high, "%.3f m"))
    view.clip.at = at - origin;
  ImGui::EndDisabled();

  if (model.hasNodes) {
    rowLabel("Nodes");
    ImGui::Checkbox("##nodes", &view.nodes);
    ImGui::SameLine();
    faintText("the balls of SLIM walls");
  }

  rowLabel("Theme");
  int theme = static_cast<int>(view.theme);
  if (choice("##theme", theme, kThemeNames)) view.theme = static_cast<Theme>(theme);

  const float width = buttonWidth(2);
  if (ImGui::Button("Reset camera", {width, 0})) view.camera = model.scene.view.camera;
  ImGui::SameLine();
  if (ImGui::Button("Save picture", {width, 0})) model.commands.savePicture = true;
  if (model.command == nullptr) return;
  if (ImGui::Button("Copy as command", {width, 0})) model.commands.copyCommand = true;
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("The command line that draws what is seen here, without a window");
}

// The panel of an effect, made from what the effect says of its parameters. Effects are shared and never
// change: a moved slider puts a changed copy in the place of the old one.
namespace {

/// A row for each field that a slider, a checkbox or a list can show.
class FieldRows final : public FieldVisitor {
 public:
  bool changed = false;

  void number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) override {
    row(key);
    // Six digits below a wide range's end are as far as a logarithmic slider goes; it ends at zero.
    const bool wide = range.max > 10;
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat |
                                   (wide ? ImGuiSliderFlags_Logarithmic : 0);
    // An open end itself is not allowed.
    const double gap = 1e-3 * (range.max - range.min);
    const double low = range.min + (range.openMin ? gap : 0), high = range.max - (range.openMax ? gap : 0);
    const std::string unit = doc.unit == "1" ? "" : " " + std::string(doc.unit);
    if (ImGui::SliderScalar(id(key).c_str(), ImGuiDataType_Double, &value, &low, &high,
                            ((wide ? "%.6g" : "%.3g") + unit).c_str(), flags))
      changed = true;
    hint(doc);
  }
  void integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) override {
    row(key);
    if (ImGui::SliderInt(id(key).c_str(), &value, static_cast<int>(range.min), static_cast<int>(range.max),
                         "%d", ImGuiSliderFlags_AlwaysClamp))
      changed = true;
    hint(doc);
  }
  void boolean(std::string_view key, bool& value, const FieldDoc& doc) override {
    row(key);
    if (ImGui::Checkbox(id(key).c_str(), &value)) changed = true;
    hint(doc);
  }
  void choice(std::string_view key, int& index, std::span<const std::string_view> names,
              const FieldDoc& doc) override {
    row(key);
    if (migiwa::choice(id(key).c_str(), index, names)) changed = true;
    hint(doc);
  }

  // What no effect has among its parameters.
  void text(std::string_view, std::string&, const FieldDoc&) override {}
  void vector(std::string_view, Vec3d&, const FieldDoc&) override {}
  void pair(std::string_view, std::array<double, 2>&, const FieldDoc&, bool*) override {}
  void triples(std::string_view, std::vector<std::array<double, 3>>&, const FieldDoc&) override {}
  void object(std::string_view, const FieldDoc&, const Fields&, bool*) override {}
  void list(std::string_view, std::size_t, const FieldDoc&,
            const std::function<void(FieldVisitor&, std::size_t)>&) override {}
  void variant(std::string_view, int&, std::span<const std::string_view>, const FieldDoc&,
               const std::function<void(FieldVisitor&, int)>&) override {}
  void fault(std::string_view, std::string_view) override {}

 private:
  static std::string id(std::string_view key) { return "##" + std::string(key); }
  static void row(std::string_view key) { rowLabel(titleOf(key).c_str()); }
  static void hint(const FieldDoc& doc) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(doc.description).c_str());
  }
};

}  // namespace

void effectPanel(PanelModel& model, NamedEffect& effect) {
  ImGui::PushID(effect.name.c_str());
  FieldRows rows;
  std::unique_ptr<Effect> copy = effect.effect->clone();
  copy->describe(rows);
  if (rows.changed) {
    effect.effect = std::move(copy);
    model.commands.settings = true;
  }
  ImGui::PopID();
}

namespace {

/// A row in the colour of its curve.
void energyRow(const char* label, ImU32 color, double value) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  rowLabel(label);
  ImGui::PopStyleColor();
  ImGui::TextUnformatted(formatNumber("%.4g J/kg", value).c_str());
}

}  // namespace

void energyPanel(PanelModel& model) {
  if (model.frame.energy.empty()) return;
  const EnergySample& now = model.frame.energy.back();
  const double start = model.frame.energy.front().source;
  energyRow("Given", theme::alert(), now.source - start);
  energyRow("Kinetic", theme::motion(), now.kinetic);
  energyRow("With potential", theme::accent(), now.kinetic + now.potential - start);
  faintText("From the start, over the mass");
  energyPlot(model.frame.energy, std::floor(7 * ImGui::GetFontSize()));
}

void gaugesPanel(PanelModel& model) {
  for (const GaugeTrace& gauge : model.frame.gauges) {
    rowLabel(gauge.name.c_str());
    if (gauge.samples.empty()) {
      faintText("nothing yet");
      continue;
    }
    ImGui::TextUnformatted((formatNumber("%.4g ", gauge.samples.back().value) + gauge.unit).c_str());
    gaugePlot(gauge.samples, std::floor(5 * ImGui::GetFontSize()));
  }
}

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
  // Points of one chart go on for equally long.
  ImGui::BeginDisabled(!whatIf.points.empty() || whatIf.busy);
  rowLabel("Frames");
  ImGui::SliderInt("##frames", &whatIf.frames, WhatIf::kFrames, 400, "%d", kLogSlider);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("Frames that the copy goes on for, %d to 400; the run waits until they are done",
                      WhatIf::kFrames);
  ImGui::EndDisabled();

  const float width = buttonWidth(2);
  ImGui::BeginDisabled(whatIf.busy);
  if (ImGui::Button(whatIf.points.empty() ? "Measure" : "Try", {width, 0})) whatIf.ask = true;
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(whatIf.points.empty() || whatIf.busy);
  if (ImGui::Button("Clear", {width, 0})) whatIf.clear = true;
  ImGui::EndDisabled();
  faintText(!whatIf.note.empty() ? whatIf.note : "The state of now and on from there, on a copy");
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
