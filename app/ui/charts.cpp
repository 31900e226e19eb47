#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <imgui.h>

#include "app/ui/ui.h"
#include "app/ui/widgets.h"
#include "core/base/messages.h"
#include "core/study/study.h"

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
  draw->AddRectFilled({left, top}, {right, bottom}, theme::well(), 3);
  for (const double value : error.ticks()) {
    gridLine(draw, left, right, std::round(at(cost.low, value).y), formatNumber("%g", value));
  }
  for (const double value : cost.ticks()) {
    const float x = std::round(at(value, error.low).x);
    draw->AddLine({x, top}, {x, bottom}, theme::gridLine());
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
    draw->AddLine(at(from.milliseconds, from.percent), at(to.milliseconds, to.percent), theme::accent());
  }
  for (const Shown& point : shown) {
    const ImVec2 place = at(point.milliseconds, point.percent);
    const ImU32 color = point.number == 0 ? theme::alert() : theme::accent();
    draw->AddCircleFilled(place, 0.25F * size, color);
    const std::string number = std::to_string(point.number + 1);
    draw->AddText({place.x + 0.4F * size, place.y - 1.1F * size}, color, number.c_str());
  }
}

namespace {

struct Plot {
  ImVec2 low, high;  ///< pixel of the lower left and of the upper right corner
  double iterations, error;

  ImVec2 at(double iteration, double value) const {
    return {low.x + (high.x - low.x) * static_cast<float>(iteration / iterations),
            low.y + (high.y - low.y) * static_cast<float>(value / error)};
  }
};

void dashedLine(ImDrawList* draw, ImVec2 from, float toX, ImU32 color) {
  constexpr float kPeriod = 7, kDash = 4;
  const int dashes = static_cast<int>(std::ceil((toX - from.x) / kPeriod));
  for (int i = 0; i < dashes; ++i) {
    const float x = from.x + kPeriod * static_cast<float>(i);
    draw->AddLine({x, from.y}, {std::min(x + kDash, toX), from.y}, color);
  }
}

}  // namespace

void errorPlot(std::span<const IterationError> errors, double tolerance, float height) {
  const ImU32 faint = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const float size = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  ImDrawList* draw = ImGui::GetWindowDrawList();

  double most = 1.25 * tolerance;
  for (const IterationError& e : errors) most = std::max(most, 1.05 * e.mean);
  if (!(most > 0) || !std::isfinite(most)) most = 1;
  const Ticks ticks = roundTicks(0, most, 3);
  const std::string format = "%." + std::to_string(ticks.decimals) + "f";
  float labels = 0;
  for (const double v : ticks.values)
    labels = std::max(labels, ImGui::CalcTextSize(formatNumber(format.c_str(), v).c_str()).x);

  const float top = std::round(0.5F * size), below = std::round(1.25F * size);
  const Plot plot{{std::round(corner.x + labels + 0.5F * size), corner.y + height - below},
                  {corner.x + width - std::round(0.5F * size), corner.y + top},
                  std::max<double>(1, static_cast<double>(errors.size()) - 1),
                  most};
  draw->AddRectFilled({plot.low.x, plot.high.y}, {plot.high.x, plot.low.y}, theme::well(), 3);
  for (const double v : ticks.values) {
    const float y = std::round(plot.at(0, v).y);
    gridLine(draw, plot.low.x, plot.high.x, y, formatNumber(format.c_str(), v));
  }
  const auto labelBelow = [&](float x, float share, const std::string& text) {
    draw->AddText({std::round(x - share * ImGui::CalcTextSize(text.c_str()).x), plot.low.y + 2}, faint,
                  text.c_str());
  };
  labelBelow(plot.low.x, 0, "0");
  labelBelow(0.5F * (plot.low.x + plot.high.x), 0.5F, "iteration");
  labelBelow(plot.high.x, 1, std::to_string(static_cast<int>(plot.iterations)));

  dashedLine(draw, plot.at(0, tolerance), plot.high.x, theme::alert());
  for (std::size_t i = 0; i + 1 < errors.size(); ++i) {
    draw->AddLine(plot.at(static_cast<double>(i), errors[i].mean),
                  plot.at(static_cast<double>(i + 1), errors[i + 1].mean), theme::accent(), 1.5F);
  }
  for (std::size_t i = 0; i < errors.size(); ++i) {
    draw->AddCircleFilled(plot.at(static_cast<double>(i), errors[i].mean), 0.17F * size, theme::accent());
  }
}

void gridLine(ImDrawList* draw, float left, float right, float y, const std::string& label) {
  const float size = ImGui::GetFontSize(), width = ImGui::CalcTextSize(label.c_str()).x;
  draw->AddLine({left, y}, {right, y}, theme::gridLine());
  draw->AddText({left - 0.4F * size - width, y - 0.5F * size - 1}, ImGui::GetColorU32(ImGuiCol_TextDisabled),
                label.c_str());
}

namespace {

/// Colours that stay apart from their neighbours in the list; more stages than colours begin again.
constexpr std::array<ImU32, 12> kStageColors{
    IM_COL32(77, 170, 214, 255),  IM_COL32(240, 172, 66, 255),  IM_COL32(88, 190, 140, 255),
    IM_COL32(222, 108, 92, 255),  IM_COL32(160, 138, 220, 255), IM_COL32(218, 210, 110, 255),
    IM_COL32(224, 142, 190, 255), IM_COL32(150, 164, 178, 255), IM_COL32(120, 210, 220, 255),
    IM_COL32(196, 140, 100, 255), IM_COL32(170, 200, 110, 255), IM_COL32(120, 130, 230, 255)};

std::string shownName(const std::string& stage) {
  std::string name = stage;
  for (char& c : name)
    if (c == '_') c = ' ';
  return name;
}

}  // namespace

ImU32 stageColor(std::size_t i) {
  return kStageColors[i % kStageColors.size()];
}

void stageBar(const StageTimes& times, bool timings) {
  const std::vector<StageTime>& stages = times.stages();
  double total = 0;
  for (const StageTime& stage : stages) total += stage.seconds;

  ImDrawList* draw = ImGui::GetWindowDrawList();
  const float size = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float height = std::round(0.85F * size);
  draw->AddRectFilled(corner, {corner.x + width, corner.y + height}, theme::well(), 3);
  if (timings && total > 0) {
    float x = corner.x;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      const float end = x + width * static_cast<float>(stages[i].seconds / total);
      draw->AddRectFilled({x, corner.y}, {end, corner.y + height}, stageColor(i));
      x = end;
    }
  }
  ImGui::Dummy({width, height});

  if (stages.empty() || !ImGui::BeginTable("stages", 2, ImGuiTableFlags_SizingStretchSame)) return;
  const float dot = std::round(0.55F * size);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float cell = ImGui::GetContentRegionAvail().x;
    const float top = std::round(at.y + 0.5F * (size - dot));
    draw->AddRectFilled({at.x, top}, {at.x + dot, top + dot}, stageColor(i), 2);
    ImGui::SetCursorScreenPos({at.x + 1.5F * dot, at.y});
    ImGui::TextUnformatted(shownName(stages[i].name).c_str());
    const std::string text = milliseconds(stages[i].seconds, timings);
    ImGui::SameLine();
    ImGui::SetCursorScreenPos({std::round(at.x + cell - ImGui::CalcTextSize(text.c_str()).x), at.y});
    ImGui::TextUnformatted(text.c_str());
  }
  ImGui::EndTable();
}

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
  draw->AddRectFilled({left, corner.y}, {right, bottom}, theme::well(), 3);
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
    draw->AddLine({left, y}, {right, y}, theme::gridLine());
    const std::string text = formatNumber(("%." + std::to_string(ticks.decimals) + "f").c_str(), value);
    draw->AddText({left - 0.4F * size - ImGui::CalcTextSize(text.c_str()).x,
                   std::clamp(y - 0.5F * size, corner.y, bottom - size)},
                  faint, text.c_str());
  }
}

}  // namespace migiwa
