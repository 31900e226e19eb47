#include <algorithm>
#include <cmath>
#include <string>

#include "app/render/image.h"
#include "app/ui/widgets.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

constexpr std::size_t kMostRows = 4;
constexpr float kRow = 1.35F, kAxis = 1.2F, kPadding = 0.4F;  // over the height of the text
constexpr float kButtons = 9.4F;
constexpr ImU32 kRun = IM_COL32(71, 184, 172, 90), kOther = IM_COL32(140, 155, 175, 60);
constexpr float kKept = 0.3F;  ///< how much of the text's colour the marks of states have

/// Times over pixels.
struct TimeScale {
  double from, until;  // (s)
  float left, width;

  float at(double time) const { return left + width * static_cast<float>((time - from) / (until - from)); }
  double timeAt(float x) const { return from + static_cast<double>((x - left) / width) * (until - from); }
};

TimeScale scaleOf(const TimeLineView& line, double duration, float left, float width) {
  double from = line.branches.front().from, until = duration;
  for (const TimeLineView::Branch& branch : line.branches) {
    from = std::min(from, branch.from);
    until = std::max(until, branch.until);
  }
  return {from, std::max(until, from + 1e-3), left, std::max(width, 1.0F)};
}

void drawRow(const TimeLineView& line, const TimeLineView::Branch& branch, const TimeScale& scale, float top,
             float height) {
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const bool present = branch.number == line.branch;
  const float bottom = top + height;
  draw->AddRectFilled({scale.left, top}, {scale.left + scale.width, bottom}, theme::well(), 3);
  draw->AddRectFilled({scale.at(branch.from), top},
                      {std::max(scale.at(branch.until), scale.at(branch.from) + 1), bottom},
                      present ? kRun : kOther, 3);
  for (const double kept : branch.kept) {
    const float x = std::floor(scale.at(kept));
    draw->AddRectFilled({x, bottom - 0.25F * height}, {x + 1, bottom},
                        ImGui::GetColorU32(ImGuiCol_Text, kKept));
  }
  const float text = ImGui::GetFontSize();
  draw->PushClipRect({scale.left, top}, {scale.left + scale.width, bottom}, true);
  draw->AddText({scale.left + 0.4F * text, std::round(top + 0.5F * (height - text) - 1)},
                ImGui::GetColorU32(ImGuiCol_Text),
                (std::to_string(branch.number) + "  " + branch.name).c_str());
  draw->PopClipRect();
  if (!present) return;
  const float x = std::round(scale.at(line.time));
  draw->AddRectFilled({x - 1, top - 1}, {x + 1, bottom + 1}, theme::motion());
  const float wide = 0.3F * text;
  draw->AddTriangleFilled({x - wide, top - 1}, {x + wide, top - 1}, {x, top + wide}, theme::motion());
}

/// Goes to the time under the mouse while it is pressed there.
void scrub(const TimeLineView::Branch& branch, const TimeScale& scale, UiCommands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  const double time = std::clamp(scale.timeAt(io.MousePos.x), branch.from, branch.until);
  // A last move may come in the frame in which the button is let go.
  const bool pressed = ImGui::IsItemActive() || ImGui::IsItemDeactivated();
  if (ImGui::IsItemActivated() || (pressed && io.MouseDelta.x != 0)) commands.goTo = {branch.number, time};
  if (!ImGui::IsItemHovered() && !ImGui::IsItemActive()) return;
  // Above the line, of which it would hide a part.
  ImGui::SetNextWindowPos({io.MousePos.x, ImGui::GetWindowPos().y - 4}, ImGuiCond_Always, {0.5F, 1});
  ImGui::SetTooltip("%.3f s on branch %d, %s", time, branch.number, branch.name.c_str());
}

void buttons(PanelModel& model) {
  const bool held = !model.run.heldFor.empty();
  ImGui::BeginDisabled(held);
  if (ImGui::ArrowButton("##back", ImGuiDir_Left)) model.commands.stepBack = true;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("A frame back (left arrow)");
  ImGui::SameLine();
  if (ImGui::ArrowButton("##forth", ImGuiDir_Right)) model.commands.step = true;
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("A frame on (right arrow)");
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::TextUnformatted(
      (formatNumber("%.3f s", model.run.line.time) + (model.run.line.underWay ? " ..." : "")).c_str());
}

}  // namespace

int timeLineHeight(std::size_t branches, float line) {
  const auto rows = static_cast<float>(std::min(branches, kMostRows));
  return static_cast<int>(std::round((rows * kRow + kAxis + 2 * kPadding) * line));
}

void timeLineStrip(PanelModel& model, ImVec2 corner, ImVec2 size) {
  const TimeLineView& line = model.run.line;
  const float text = ImGui::GetFontSize(), padding = std::round(kPadding * text);
  ImGui::SetNextWindowPos(corner);
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {padding, padding});
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration & ~ImGuiWindowFlags_NoScrollbar;
  ImGui::Begin("Time line", nullptr, kFixed | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar();
  const ImVec2 start = ImGui::GetCursorPos();
  buttons(model);
  const float shift = std::round(kButtons * text);
  const float left = ImGui::GetWindowPos().x + start.x + shift;
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x - padding;
  const TimeScale scale = scaleOf(line, model.scene.duration, left, right - left);
  const float row = std::round(kRow * text);
  float y = start.y;
  for (const TimeLineView::Branch& branch : line.branches) {
    ImGui::SetCursorPos({start.x + shift, y});
    const float top = ImGui::GetCursorScreenPos().y;
    ImGui::InvisibleButton(("branch " + std::to_string(branch.number)).c_str(), {scale.width, row - 2});
    scrub(branch, scale, model.commands);
    drawRow(line, branch, scale, top, row - 2);
    y += row;
  }
  ImGui::SetCursorPos({start.x + shift, y});
  const float top = ImGui::GetCursorScreenPos().y;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const auto [values, labels] =
      labelledTicks({scale.from, scale.until}, 8, scale.width, 0, ImGui::GetFont(), " s");
  for (std::size_t k = 0; k < values.size(); ++k) {
    const float wide = ImGui::CalcTextSize(labels[k].c_str()).x;
    const float x =
        std::clamp(scale.at(values[k]) - 0.5F * wide, scale.left, scale.left + scale.width - wide);
    draw->AddText({std::round(x), top}, ImGui::GetColorU32(ImGuiCol_TextDisabled), labels[k].c_str());
  }
  ImGui::Dummy({1, std::round(kAxis * text) - 2});
  ImGui::End();
}

}  // namespace migiwa
