// Plots over the time of the run: energy, gauges, and measures with the run's branches and "What if"
// overlaid.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <imgui.h>

#include "app/ui/ui.h"
#include "app/ui/widgets.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

/// Of the values of a plot.
struct ValueRange {
  double low = 0, high = 0;
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value), high = std::max(high, value);
  }
};

void polyline(ImDrawList* draw, const std::vector<ImVec2>& points, ImU32 color) {
  draw->AddPolyline(points.data(), static_cast<int>(points.size()), color, 0, 1.5F);
}

/// Values over the time from 0 to `last` (s): draws the axes, and says where curves go.
class TimePlot {
 public:
  TimePlot(const ImVec2& corner, float width, float height, ValueRange range, double last)
      : range_(range), last_(std::max(last, 1e-9)) {
    const float size = ImGui::GetFontSize();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImU32 faint = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    // What differs by rounding alone is drawn as what it is, constant.
    const double largest = std::max(std::abs(range_.low), std::abs(range_.high));
    if (range_.high - range_.low <= 1e-5 * largest) range_.high = range_.low + std::max(1.0, largest);
    const double room = 0.06 * (range_.high - range_.low);
    range_.low -= room, range_.high += room;
    Ticks ticks = roundTicks(range_.low, range_.high, 3);
    for (int wanted = 4; ticks.values.size() < 2 && wanted < 8; ++wanted)
      ticks = roundTicks(range_.low, range_.high, wanted);
    const std::string format = "%." + std::to_string(ticks.decimals) + "f";
    float labels = 0;
    for (const double v : ticks.values)
      labels = std::max(labels, ImGui::CalcTextSize(formatNumber(format.c_str(), v).c_str()).x);
    low_ = {std::round(corner.x + labels + 0.5F * size), corner.y + height - std::round(1.25F * size)};
    high_ = {corner.x + width - std::round(0.5F * size), corner.y + std::round(0.5F * size)};
    draw->AddRectFilled({low_.x, high_.y}, {high_.x, low_.y}, theme::well(), 3);
    for (const double v : ticks.values) {
      gridLine(draw, low_.x, high_.x, std::round(at(0, v).y), formatNumber(format.c_str(), v));
    }
    const std::string end = formatNumber("%.2f s", last);
    draw->AddText({low_.x, low_.y + 2}, faint, "0 s");
    draw->AddText({std::round(high_.x - ImGui::CalcTextSize(end.c_str()).x), low_.y + 2}, faint, end.c_str());
  }

  ImVec2 at(double time, double value) const {
    return {
        low_.x + (high_.x - low_.x) * static_cast<float>(time / last_),
        low_.y + (high_.y - low_.y) * static_cast<float>((value - range_.low) / (range_.high - range_.low))};
  }

 private:
  ValueRange range_;
  double last_;
  ImVec2 low_, high_;
};

}  // namespace

void gaugePlot(std::span<const GaugeSample> samples, float height) {
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  if (samples.empty()) return;
  ValueRange range{samples.front().value, samples.front().value};
  for (const GaugeSample& one : samples) range.include(one.value);
  const TimePlot plot(corner, width, height, range, samples.back().time);
  std::vector<ImVec2> points;
  for (const GaugeSample& one : samples)
    if (std::isfinite(one.value)) points.push_back(plot.at(one.time, one.value));
  polyline(ImGui::GetWindowDrawList(), points, theme::accent());
}

void energyPlot(std::span<const EnergySample> samples, float height) {
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  if (samples.empty()) return;
  ImDrawList* draw = ImGui::GetWindowDrawList();

  const double start = samples.front().source;
  ValueRange range;
  for (const EnergySample& at : samples) {
    range.include(at.kinetic);
    range.include(at.kinetic + at.potential - start);
    range.include(at.source - start);
  }
  const TimePlot plot(corner, width, height, range, samples.back().time);
  std::vector<ImVec2> kinetic, whole, given;
  for (const EnergySample& one : samples) {
    if (!std::isfinite(one.kinetic + one.potential)) continue;
    kinetic.push_back(plot.at(one.time, one.kinetic));
    whole.push_back(plot.at(one.time, one.kinetic + one.potential - start));
    given.push_back(plot.at(one.time, one.source - start));
  }
  polyline(draw, given, theme::alert());
  polyline(draw, kinetic, theme::motion());
  polyline(draw, whole, theme::accent());
}

namespace {

/// Apart for colour-blind eyes, too (Okabe and Ito 2008); more curves than colours begin again.
constexpr std::array<ImU32, 7> kCurveColors{IM_COL32(86, 180, 233, 255),  IM_COL32(230, 159, 0, 255),
                                            IM_COL32(0, 158, 115, 255),   IM_COL32(213, 94, 0, 255),
                                            IM_COL32(204, 121, 167, 255), IM_COL32(0, 114, 178, 255),
                                            IM_COL32(150, 150, 150, 255)};

struct Curve {
  std::string name;
  ImU32 color;
  bool present;  ///< of the branch on which the run is
  bool apart;    ///< of a copy
  MeasureSamples samples;
};

std::vector<Curve> curvesOf(const TimeLineView& line, const WhatIfModel* whatIf) {
  std::vector<Curve> curves;
  const auto add = [&](std::string name, std::size_t color, bool present, bool apart,
                       const MeasureSamples& samples) {
    if (samples != nullptr && !samples->empty())
      curves.push_back({std::move(name), kCurveColors[color % kCurveColors.size()], present, apart, samples});
  };
  std::size_t next = 0;
  for (const TimeLineView::Branch& branch : line.branches) {
    const auto color = static_cast<std::size_t>(branch.number - 1);
    next = std::max(next, color + 1);
    add(std::to_string(branch.number) + "  " + branch.name, color, branch.number == line.branch, false,
        branch.trace);
  }
  if (whatIf == nullptr) return curves;
  for (std::size_t k = 0; k < whatIf->points.size(); ++k)
    add("what if " + std::to_string(k + 1) + ": " + whatIf->points[k].label, next + k, false, true,
        whatIf->points[k].trace);
  return curves;
}

/// The last value at or before a time (s); not a number where there is none.
float valueAt(const std::vector<MeasureSample>& samples, RunMeasure measure, double time) {
  float value = std::numeric_limits<float>::quiet_NaN();
  for (const MeasureSample& one : samples)
    if (one.time <= time + 1e-9) value = one[measure];
  return value;
}

void drawCurve(const Curve& curve, RunMeasure measure, const TimePlot& plot) {
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const float width = curve.present ? 2.2F : 1.3F;
  std::vector<ImVec2> points;
  const auto flush = [&] {
    draw->AddPolyline(points.data(), static_cast<int>(points.size()), curve.color, 0, width);
    points.clear();
  };
  for (const MeasureSample& one : *curve.samples) {
    if (!std::isfinite(one[measure])) {
      flush();
      continue;
    }
    const ImVec2 at = plot.at(one.time, static_cast<double>(one[measure]));
    if (points.empty() || at.x - points.back().x > 0.5F || &one == &curve.samples->back())
      points.push_back(at);
  }
  const bool ends = curve.apart && !points.empty();
  const ImVec2 end = ends ? points.back() : ImVec2();
  flush();
  if (ends) draw->AddCircleFilled(end, 0.2F * ImGui::GetFontSize(), curve.color);
}

void plotMeasure(const std::vector<Curve>& curves, RunMeasure measure, const TimeLineView& line,
                 float height) {
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  ValueRange range{1e300, -1e300};
  double last = line.time;
  for (const Curve& curve : curves) {
    last = std::max(last, curve.samples->back().time);
    for (const MeasureSample& one : *curve.samples) range.include(static_cast<double>(one[measure]));
  }
  if (range.low > range.high) range = {0, 1};
  const TimePlot plot(corner, width, height, range, last);
  const ImVec2 low = plot.at(line.time, range.low), high = plot.at(line.time, range.high);
  ImGui::GetWindowDrawList()->AddLine(low, high, theme::motion());
  for (const bool present : {false, true})
    for (const Curve& curve : curves)
      if (curve.present == present) drawCurve(curve, measure, plot);
}

/// A row for each curve: its colour, its name and, of one measure, what it is now.
void curveLegend(const std::vector<Curve>& curves, std::optional<RunMeasure> measure, double time) {
  const float size = ImGui::GetFontSize(), room = ImGui::GetContentRegionAvail().x;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  for (const Curve& curve : curves) {
    std::string value;
    if (measure) {
      const float now = valueAt(*curve.samples, *measure, time);
      value = std::isfinite(now) ? formatNumber("%.4g", static_cast<double>(now)) : "-";
    }
    const float wide = ImGui::CalcTextSize(value.c_str()).x, swatch = 1.6F * size;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float middle = std::round(at.y + 0.55F * size);
    draw->AddLine({at.x, middle}, {at.x + 1.1F * size, middle}, curve.color, curve.present ? 3.0F : 1.6F);
    const std::string name = fitted(curve.name, room - swatch - wide - size);
    ImGui::SetCursorScreenPos({at.x + swatch, at.y});
    ImGui::TextUnformatted(name.c_str());
    if (name != curve.name && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", curve.name.c_str());
    draw->AddText({std::round(at.x + room - wide), at.y}, ImGui::GetColorU32(ImGuiCol_Text), value.c_str());
  }
}

}  // namespace

void plotsPanel(PanelModel& model) {
  std::vector<std::string_view> names(kMeasureNames.begin(), kMeasureNames.end());
  names.push_back("all measures");
  rowLabel("Plot of");
  int plotted = static_cast<int>(model.view.plotted);
  if (choice("##plotted", plotted, names)) model.view.plotted = static_cast<std::size_t>(plotted);
  const std::vector<Curve> curves = curvesOf(model.run.line, model.whatIf);
  if (curves.empty()) return faintText("Nothing yet");
  const bool all = model.view.plotted >= kMeasureCount;
  const float height = std::floor((all ? 4.6F : 7.5F) * ImGui::GetFontSize());
  for (std::size_t k = 0; k < kMeasureCount; ++k) {
    if (!all && k != model.view.plotted) continue;
    const auto measure = static_cast<RunMeasure>(k);
    const std::string unit = kMeasureUnits[k] == "1" ? "" : " (" + std::string(kMeasureUnits[k]) + ")";
    faintText(titleOf(kMeasureNames[k]) + unit + " over time");
    if (measure == RunMeasure::milliseconds && !model.timings)
      faintText("not shown: it differs from run to run");
    else
      plotMeasure(curves, measure, model.run.line, height);
  }
  const bool told =
      !all && (model.timings || static_cast<RunMeasure>(model.view.plotted) != RunMeasure::milliseconds);
  curveLegend(curves, told ? std::optional(static_cast<RunMeasure>(model.view.plotted)) : std::nullopt,
              model.run.line.time);
}

}  // namespace migiwa
