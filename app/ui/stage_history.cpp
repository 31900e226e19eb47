#include "app/ui/stage_history.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "app/ui/number_text.h"
#include "app/ui/stage_bar.h"
#include "app/ui/theme.h"

namespace migiwa {

void StageHistory::add(long steps, const StageTimes& times) {
  if (steps == steps_ || times.stages().empty()) return;
  if (steps < steps_) frames_.clear();  // begun anew
  steps_ = steps;
  frames_.push_back(times);
  if (frames_.size() > kFrames) frames_.pop_front();
}

void stageChart(const StageHistory& history, float height) {
  const std::deque<StageTimes>& frames = history.frames();
  const float size = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const float left = std::round(corner.x + 2.2F * size), right = corner.x + width, bottom = corner.y + height;
  draw->AddRectFilled({left, corner.y}, {right, bottom}, theme::kWell, 3);
  if (frames.empty()) return;

  // One frame that was held up does not flatten all others.
  std::vector<double> totals;
  for (const StageTimes& frame : frames) {
    double total = 0;
    for (const StageTime& stage : frame.stages()) total += 1e3 * stage.seconds;
    totals.push_back(total);
  }
  std::sort(totals.begin(), totals.end());
  const double most = std::max(1.25 * totals[(totals.size() - 1) * 95 / 100], 1e-3);
  const auto heightOf = [&](double milliseconds) {
    return (bottom - corner.y) * static_cast<float>(std::min(milliseconds / most, 1.0));
  };

  const float bar = (right - left) / static_cast<float>(StageHistory::kFrames);
  const std::vector<StageTime>& order = frames.back().stages();
  float x = right - bar * static_cast<float>(frames.size());
  for (const StageTimes& frame : frames) {
    double below = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
      const double own = 1e3 * frame.seconds(order[k].name);
      draw->AddRectFilled({x, bottom - heightOf(below + own)}, {x + bar, bottom - heightOf(below)},
                          stageColor(k));
      below += own;
    }
    x += bar;
  }
  const ImU32 faint = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const Ticks ticks = roundTicks(0, most, 2);
  for (const double value : ticks.values) {
    const float y = std::round(bottom - heightOf(value));
    draw->AddLine({left, y}, {right, y}, theme::kGridLine);
    const std::string text = formatNumber(("%." + std::to_string(ticks.decimals) + "f").c_str(), value);
    draw->AddText({left - 0.4F * size - ImGui::CalcTextSize(text.c_str()).x,
                   std::clamp(y - 0.5F * size, corner.y, bottom - size)},
                  faint, text.c_str());
  }
}

}  // namespace migiwa
