#include "app/ui/cost_chart.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "app/ui/number_text.h"
#include "app/ui/plot_grid.h"
#include "app/ui/theme.h"
#include "core/study/pareto.h"

namespace migiwa {
namespace {

/// What is not there to be seen is drawn at the floor (%).
constexpr double kLeastError = 1e-3;

/// A logarithmic axis over a range, with at least a factor of 4 to see.
struct LogAxis {
  double low, high;

  LogAxis(double least, double most) {
    const double spread = std::max(most / least, 4.0), middle = std::sqrt(least * most);
    low = middle / std::sqrt(1.6 * spread), high = middle * std::sqrt(1.6 * spread);
  }
  float share(double value) const { return static_cast<float>(std::log(value / low) / std::log(high / low)); }
  /// 1, 2 and 5 times powers of ten; powers alone where those are many.
  std::vector<double> ticks() const {
    std::vector<double> values;
    const bool all = std::log10(high / low) < 2.5;
    for (int power = static_cast<int>(std::floor(std::log10(low))); power <= 6; ++power)
      for (const double step : {1.0, 2.0, 5.0}) {
        const double value = step * std::pow(10, power);
        if (value >= low && value <= high && (all || step == 1.0)) values.push_back(value);
      }
    return values;
  }
};

struct Shown {
  std::size_t number;
  double milliseconds, percent;
};

}  // namespace

void costChart(std::span<const WhatIfPoint> points, float height) {
  const float size = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  std::vector<Shown> shown;
  std::vector<CostAndError> measured;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!points[k].densityError || !points[k].trouble.empty() || !(points[k].milliseconds > 0)) continue;
    shown.push_back({k, points[k].milliseconds, std::max(100 * *points[k].densityError, kLeastError)});
    measured.push_back({shown.back().milliseconds, shown.back().percent});
  }
  if (shown.empty()) return;
  const auto [cheapest, dearest] =
      std::minmax_element(shown.begin(), shown.end(),
                          [](const Shown& a, const Shown& b) { return a.milliseconds < b.milliseconds; });
  const auto [best, worst] = std::minmax_element(
      shown.begin(), shown.end(), [](const Shown& a, const Shown& b) { return a.percent < b.percent; });
  const LogAxis cost(cheapest->milliseconds, dearest->milliseconds), error(best->percent, worst->percent);

  ImDrawList* draw = ImGui::GetWindowDrawList();
  const ImU32 faint = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const float left = std::round(corner.x + 3.0F * size), bottom = std::round(corner.y + height - 1.4F * size);
  const float right = std::round(corner.x + width - 0.5F * size), top = std::round(corner.y + 1.4F * size);
  const auto at = [&](double milliseconds, double percent) {
    return ImVec2(left + (right - left) * cost.share(milliseconds),
                  bottom + (top - bottom) * error.share(percent));
  };
  draw->AddRectFilled({left, top}, {right, bottom}, theme::kWell, 3);
  for (const double value : error.ticks()) {
    gridLine(draw, left, right, std::round(at(cost.low, value).y), formatNumber("%g", value));
  }
  for (const double value : cost.ticks()) {
    const float x = std::round(at(value, error.low).x);
    draw->AddLine({x, top}, {x, bottom}, theme::kGridLine);
    const std::string text = formatNumber("%g", value);
    draw->AddText({std::round(x - 0.5F * ImGui::CalcTextSize(text.c_str()).x), bottom + 2}, faint,
                  text.c_str());
  }
  draw->AddText({corner.x, corner.y}, faint, "density error (%)");
  const char* const across = "ms per step";
  draw->AddText({right - ImGui::CalcTextSize(across).x, corner.y}, faint, across);

  const std::vector<std::size_t> front = paretoFront(measured);
  for (std::size_t k = 0; k + 1 < front.size(); ++k) {
    const Shown &from = shown[front[k]], &to = shown[front[k + 1]];
    draw->AddLine(at(from.milliseconds, from.percent), at(to.milliseconds, to.percent), theme::kAccent);
  }
  for (const Shown& point : shown) {
    const ImVec2 place = at(point.milliseconds, point.percent);
    const ImU32 color = point.number == 0 ? theme::kAlert : theme::kAccent;
    draw->AddCircleFilled(place, 0.25F * size, color);
    const std::string number = std::to_string(point.number + 1);
    draw->AddText({place.x + 0.4F * size, place.y - 1.1F * size}, color, number.c_str());
  }
}

}  // namespace migiwa
