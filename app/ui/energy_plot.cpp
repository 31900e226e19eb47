#include "app/ui/energy_plot.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <imgui.h>

#include "app/ui/number_text.h"
#include "app/ui/plot_grid.h"
#include "app/ui/theme.h"

namespace migiwa {
namespace {

struct EnergyRange {
  double low = 0, high = 0;
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value), high = std::max(high, value);
  }
};

void polyline(ImDrawList* draw, const std::vector<ImVec2>& points, ImU32 color) {
  draw->AddPolyline(points.data(), static_cast<int>(points.size()), color, 0, 1.5F);
}

}  // namespace

void energyPlot(std::span<const EnergySample> samples, float height) {
  const float size = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  if (samples.empty()) return;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const ImU32 faint = ImGui::GetColorU32(ImGuiCol_TextDisabled);

  const double start = samples.front().source;
  EnergyRange range;
  for (const EnergySample& at : samples) {
    range.include(at.kinetic);
    range.include(at.kinetic + at.potential - start);
    range.include(at.source - start);
  }
  if (range.high - range.low <= 0) range.high = 1;
  const double room = 0.06 * (range.high - range.low);
  range.low -= room, range.high += room;
  const Ticks ticks = roundTicks(range.low, range.high, 3);
  const std::string format = "%." + std::to_string(ticks.decimals) + "f";
  float labels = 0;
  for (const double v : ticks.values)
    labels = std::max(labels, ImGui::CalcTextSize(formatNumber(format.c_str(), v).c_str()).x);

  const ImVec2 low{std::round(corner.x + labels + 0.5F * size), corner.y + height - std::round(1.25F * size)};
  const ImVec2 high{corner.x + width - std::round(0.5F * size), corner.y + std::round(0.5F * size)};
  const double last = std::max(samples.back().time, 1e-9);
  const auto at = [&](double time, double value) {
    return ImVec2{
        low.x + (high.x - low.x) * static_cast<float>(time / last),
        low.y + (high.y - low.y) * static_cast<float>((value - range.low) / (range.high - range.low))};
  };
  draw->AddRectFilled({low.x, high.y}, {high.x, low.y}, theme::kWell, 3);
  for (const double v : ticks.values) {
    gridLine(draw, low.x, high.x, std::round(at(0, v).y), formatNumber(format.c_str(), v));
  }
  const std::string end = formatNumber("%.2f s", samples.back().time);
  draw->AddText({low.x, low.y + 2}, faint, "0 s");
  draw->AddText({std::round(high.x - ImGui::CalcTextSize(end.c_str()).x), low.y + 2}, faint, end.c_str());

  std::vector<ImVec2> kinetic, whole, given;
  for (const EnergySample& one : samples) {
    if (!std::isfinite(one.kinetic + one.potential)) continue;
    kinetic.push_back(at(one.time, one.kinetic));
    whole.push_back(at(one.time, one.kinetic + one.potential - start));
    given.push_back(at(one.time, one.source - start));
  }
  polyline(draw, given, theme::kAlert);
  polyline(draw, kinetic, theme::kMotion);
  polyline(draw, whole, theme::kAccent);
}

}  // namespace migiwa
