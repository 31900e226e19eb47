// The particles that were selected: how many, how a field is spread over them, and their table.
#include "app/session/selection.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "app/ui/widgets.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

/// Fills the width of the current ImGui window.
void histogram(const FieldSpread& spread, const std::string& unit, float height) {
  const float size = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const std::size_t most =
      std::max<std::size_t>(*std::max_element(spread.bins.begin(), spread.bins.end()), 1);
  const float left = std::round(corner.x + ImGui::CalcTextSize(groupedDigits(most).c_str()).x + 0.6F * size),
              right = corner.x + width - std::round(0.5F * size);
  const float top = corner.y + std::round(0.5F * size), bottom = corner.y + height - std::round(1.25F * size);
  draw->AddRectFilled({left, top}, {right, bottom}, theme::well(), 3);
  gridLine(draw, left, right, top, groupedDigits(most));
  gridLine(draw, left, right, bottom, "0");
  const float bar = (right - left) / static_cast<float>(FieldSpread::kBins);
  for (std::size_t k = 0; k < FieldSpread::kBins; ++k) {
    const float share = static_cast<float>(spread.bins[k]) / static_cast<float>(most);
    const float x = left + bar * static_cast<float>(k);
    draw->AddRectFilled({x + 0.5F, bottom - share * (bottom - top)}, {x + bar - 0.5F, bottom},
                        theme::accent());
  }
  const ImU32 faint = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const std::string low = formatNumber("%.4g", spread.least),
                    high = formatNumber("%.4g ", spread.largest) + unit;
  draw->AddText({left, bottom + 2}, faint, low.c_str());
  draw->AddText({std::round(right - ImGui::CalcTextSize(high.c_str()).x), bottom + 2}, faint, high.c_str());
}

}  // namespace

void selectionPanel(PanelModel& model) {
  SelectionModel& selection = *model.selection;
  selection.shown = true;
  rowLabel("Selected");
  ImGui::TextUnformatted((groupedDigits(selection.here) + " of " + groupedDigits(selection.all)).c_str());
  const float width = buttonWidth(2);
  const char* const tool = selection.tool ? "Drag over them" : "Select";
  ImGui::BeginDisabled(model.view.water);
  if (ImGui::Button(tool, {width, 0})) selection.tool = !selection.tool;
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    ImGui::SetTooltip(model.view.water ? "Where water is shown there is nothing to select"
                                       : "The next drag over the picture selects what is in its rectangle,\n"
                                         "behind it, too; a drag with the control key does so at any time");
  ImGui::SameLine();
  ImGui::BeginDisabled(selection.ids.empty());
  if (ImGui::Button("Clear", {width, 0})) selection.ids.clear();
  ImGui::EndDisabled();
  rowLabel("Spread of");
  int field = static_cast<int>(selection.field);
  if (choice("##particle_field", field, kParticleValueNames))
    selection.field = static_cast<ParticleValue>(field);
  if (selection.spread && selection.spread->count > 0) {
    const FieldSpread& spread = *selection.spread;
    const std::string unit = unitOf(selection.field) == "1" ? "" : std::string(unitOf(selection.field));
    rowLabel("Mean");
    ImGui::TextUnformatted(
        (formatNumber("%.5g", spread.mean) + formatNumber(" ± %.3g ", spread.deviation) + unit).c_str());
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("Of %s, and their standard deviation",
                        selection.ids.empty() ? "all particles" : "those selected");
    histogram(spread, unit, std::floor(6 * ImGui::GetFontSize()));
  } else {
    faintText(selection.field == ParticleValue::pressure ? "from the next step on" : "No particle has it");
  }
  rowLabel("File");
  ImGui::InputText("##particles_file", &selection.fileName);
  ImGui::BeginDisabled(selection.fileName.empty());
  if (ImGui::Button("CSV of particles", {width, 0})) model.commands.saveParticles = true;
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("A row for each: id, place, velocity, density, γ and so on, with units");
  if (!selection.note.empty()) ImGui::TextWrapped("%s", selection.note.c_str());
}

void selectionOverlay(const SelectionModel& model, const FrameView& frame, const Projection& projection,
                      const Rect& area) {
  /// More dots than that hide each other.
  constexpr std::size_t kMostDots = 4000;
  constexpr ImU32 kDot = IM_COL32(255, 214, 64, 255), kDotEdge = IM_COL32(24, 34, 46, 200),
                  kInside = IM_COL32(255, 214, 64, 40);
  ImDrawList* draw = ImGui::GetBackgroundDrawList();
  draw->PushClipRect({static_cast<float>(area.x), static_cast<float>(area.y)},
                     {static_cast<float>(area.x + area.width), static_cast<float>(area.y + area.height)});
  if (!model.ids.empty()) {
    const std::vector<std::size_t> places = selectedIn(frame, model.ids);
    const std::size_t each = 1 + places.size() / kMostDots;
    for (std::size_t k = 0; k < places.size(); k += each) {
      const auto at = pixelOf(frame.positions[places[k]].xyz(), projection, area);
      if (!at) continue;
      const ImVec2 middle{(*at)[0], (*at)[1]};
      draw->AddRectFilled({middle.x - 2, middle.y - 2}, {middle.x + 2, middle.y + 2}, kDotEdge);
      draw->AddRectFilled({middle.x - 1, middle.y - 1}, {middle.x + 1, middle.y + 1}, kDot);
    }
  }
  if (const auto& r = model.rectangle) {
    draw->AddRectFilled({(*r)[0], (*r)[1]}, {(*r)[2], (*r)[3]}, kInside);
    draw->AddRect({(*r)[0], (*r)[1]}, {(*r)[2], (*r)[3]}, kDotEdge);
  }
  draw->PopClipRect();
}

}  // namespace migiwa
