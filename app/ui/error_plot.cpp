#include "app/ui/error_plot.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <imgui.h>

#include "app/ui/number_text.h"
#include "app/ui/plot_grid.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"

namespace migiwa {
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
  draw->AddRectFilled({plot.low.x, plot.high.y}, {plot.high.x, plot.low.y}, theme::kWell, 3);
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

  dashedLine(draw, plot.at(0, tolerance), plot.high.x, theme::kAlert);
  for (std::size_t i = 0; i + 1 < errors.size(); ++i) {
    draw->AddLine(plot.at(static_cast<double>(i), errors[i].mean),
                  plot.at(static_cast<double>(i + 1), errors[i + 1].mean), theme::kAccent, 1.5F);
  }
  for (std::size_t i = 0; i < errors.size(); ++i) {
    draw->AddCircleFilled(plot.at(static_cast<double>(i), errors[i].mean), 0.17F * size, theme::kAccent);
  }
}

}  // namespace migiwa
