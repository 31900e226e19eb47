// The pieces that panels are made of: rows, charts, colours and fonts.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <imgui.h>

#include "app/render/image.h"
#include "app/render/projection.h"
#include "app/session/ui_state.h"
#include "core/base/parallel.h"
#include "core/scene/scene.h"
#include "core/simulation/frame_view.h"
#include "core/simulation/statistics.h"

namespace migiwa {

// Small pieces that the panels share.

/// A scene key as a label: "surface_tension" is "Surface tension".
std::string titleOf(std::string_view key);
/// A label in the left column; the next widget fills the right one.
void rowLabel(const char* label);
/// Where the right column of a row is (pixels), by its label.
struct RowPlace {
  std::string label;
  std::string panel;  ///< the title of its panel
  float x, y, width, height;
};
/// Where a panel that is open has its widgets (pixels), by its title.
struct PanelPlace {
  std::string title;
  float top, bottom;
};
/// Rows from now on are in that panel; `open` false: no longer.
void markPanel(const char* title, bool open);
std::span<const PanelPlace> panelPlaces();
/// Of the last frame, in the order in which they are drawn.
std::span<const RowPlace> rowPlaces();
/// A frame begins.
void forgetRows();
/// A drop-down list over names; returns whether `index` changed. It may begin beyond them.
bool choice(const char* id, int& index, std::span<const std::string_view> names);
/// What sliders of numbers have that span powers of ten.
constexpr ImGuiSliderFlags kLogSlider = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic;
bool logSlider(const char* id, double& value, double low, double high, const char* format);
/// While the mouse is over the last widget: what the scene's key of that JSON pointer means, its range and
/// what a change costs.
void keyHint(std::string_view pointer);
/// Text in the panels' fainter colour.
void faintText(std::string_view text);
/// The text as far as it fits into the width (pixels), with an ellipsis for what does not.
std::string fitted(std::string text, float width);
/// `count` buttons side by side: the width of each.
float buttonWidth(int count);

// Rows of settings that several panels have. Each returns whether the user changed something.

/// How walls are handled, and the method of gamma.
bool wallRows(BoundaryParameters& boundary);
bool maxIterationsRow(SolverParameters& solver);
bool toleranceRow(SolverParameters& solver);

// The program's panels. They are drawn one under the other in the current ImGui window.

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
/// What was changed, to be taken back and done again.
void changesPanel(PanelModel& model);
/// Needs the model's section.
void sectionPanel(PanelModel& model);
/// Needs the model's selection.
void selectionPanel(PanelModel& model);
void performancePanel(PanelModel& model);
/// Energies over the run, against what was given.
void energyPanel(PanelModel& model);
void gaugesPanel(PanelModel& model);
/// Measures over the run, with its branches and what "What if" has tried.
void plotsPanel(PanelModel& model);

// The time line under the scene: a row for each branch, with the states that are kept, on which one goes
// back.

/// With a row for each of so many branches, as far as rows are shown (pixels); `line`: height of the text.
int timeLineHeight(std::size_t branches, float line);
void timeLineStrip(PanelModel& model, ImVec2 corner, ImVec2 size);

// The particle that is looked into.

/// Over the picture: its neighbours and its support ball, with the part behind walls shaded.
void inspectorOverlay(const InspectModel& model, const FrameInfo& frame, const Projection& projection,
                      const Rect& area);
/// In the upper right corner of `area`: its values, and gamma by every method.
void inspectorCard(InspectModel& model, const FrameInfo& frame, const Vec3d& origin, const Rect& area);

/// Over the picture: the particles that are selected, and the rectangle that is being drawn.
void selectionOverlay(const SelectionModel& model, const FrameView& frame, const Projection& projection,
                      const Rect& area);

/// What the section has under the mouse.
void sectionPointer(const SectionModel& model, const ColorFieldInfo& info, const Vec3d& origin);

// The fonts of panels and pictures: DejaVu Sans, with the Greek and the signs that formulas need.

struct Fonts {
  ImFont* regular = nullptr;
  ImFont* bold = nullptr;
  ImFont* mono = nullptr;
};

/// Adds them to the current ImGui context's atlas. Throws MissingError with the package to install.
Fonts loadFonts(float pixels);

// What the colours mean: name and unit of the quantity, the colour map, and numbers beside it.

/// Of a legend and the margin below it (pixels).
int legendHeight(const Fonts& fonts);

/// Draws it in the bottom right corner of `area`.
void drawLegend(const ColorFieldInfo& field, const std::array<double, 2>& range, const ColorMap& colors,
                const Rect& area, const Fonts& fonts);

// What axes have in common.

/// Round values of a range, with their labels.
struct LabelledTicks {
  std::vector<double> values;
  std::vector<std::string> labels;
};

/// As many, up to `most`, as stand apart along an axis of that width, `beyond` whose ends they may reach so
/// far (pixels).
LabelledTicks labelledTicks(const std::array<double, 2>& range, int most, float width, float beyond,
                            ImFont* font, const char* unit = "");

/// A grid line at the height y from `left` to `right` (pixels), with its label to the left of it.
void gridLine(ImDrawList* draw, float left, float right, float y, const std::string& label);

// Where the time of a frame went: one bar of stages, and under it their names and milliseconds.

/// The colour of the i-th stage.
ImU32 stageColor(std::size_t i);

/// `timings` false draws the stages without their times, which differ from run to run.
void stageBar(const StageTimes& times, bool timings);

// Accuracy against time: a point for each setting that was tried.

/// Density error (%) over milliseconds a step, both logarithmic; points bear their number from 1, and the
/// Pareto front is drawn through those that no other beats in both. Fills the width of the current ImGui
/// window.
void costChart(std::span<const WhatIfPoint> points, float height);

// The energy of the fluid over the run, against what was given to it.

/// Fills the width of the current ImGui window; `height` is that of the plot with its labels (pixels).
/// Heights count from the energy of the start.
void energyPlot(std::span<const EnergySample> samples, float height);

/// The same for what a gauge has shown.
void gaugePlot(std::span<const GaugeSample> samples, float height);

// How the density error falls from iteration to iteration of the last step.

/// Fills the width of the current ImGui window; `height` is that of the plot with its labels (pixels).
void errorPlot(std::span<const IterationError> errors, double tolerance, float height);

/// Draws the command line that reproduces what is seen over `area`, if it is open.
void commandWindow(CommandModel& model, const Rect& area, const Fonts& fonts);

/// Draws the list of keys and mouse over `area`, if it is open (app/ui/bindings.h).
void bindingsWindow(bool& open, const Rect& area);

/// Draws the gallery's window over `area`, if it is open.
void galleryWindow(GalleryModel& model, const Rect& area, const Fonts& fonts);

// Colours and spacings of panels and of the text on pictures.

namespace theme {
inline constexpr ImU32 kInk = IM_COL32(24, 34, 46, 255);        ///< text on the picture
inline constexpr ImU32 kFaintInk = IM_COL32(82, 97, 114, 255);  ///< its labels
inline constexpr ImU32 kPaper = IM_COL32(250, 251, 252, 205);   ///< behind it
inline constexpr ImU32 kPaperEdge = IM_COL32(60, 75, 95, 60);
// Of panels, by the theme of the current ImGui context, in whose style they are kept where ImGui has no use
// for them.
inline ImU32 alert() {
  return ImGui::GetColorU32(ImGuiCol_PlotLinesHovered);
}
inline ImU32 accent() {
  return ImGui::GetColorU32(ImGuiCol_PlotLines);
}
/// Curves of what moves.
inline ImU32 motion() {
  return ImGui::GetColorU32(ImGuiCol_PlotHistogram);
}
/// Behind plots and bars.
inline ImU32 well() {
  return ImGui::GetColorU32(ImGuiCol_TableRowBgAlt);
}
inline ImU32 gridLine() {
  return ImGui::GetColorU32(ImGuiCol_TableBorderLight);
}
}  // namespace theme

/// Sets the current ImGui context's style for text of `pixels` height.
void applyTheme(float pixels, Theme theme);

/// Draws the editor's window over `area`, if it is open.
void sceneEditorWindow(SceneEditor& editor, const Rect& area, const Fonts& fonts);

}  // namespace migiwa
