#include "app/ui/widgets.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "app/ui/ui.h"
#include "core/base/messages.h"
#include "core/gamma/gamma_method.h"

namespace migiwa {

std::string titleOf(std::string_view key) {
  std::string title(key);
  std::replace(title.begin(), title.end(), '_', ' ');
  if (!title.empty()) title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

namespace {

std::vector<PanelPlace>& panelsOfFrame() {
  static std::vector<PanelPlace> panels;
  return panels;
}

std::string& panelOfRows() {
  static std::string title;
  return title;
}

std::vector<RowPlace>& rowsOfFrame() {
  static std::vector<RowPlace> rows;
  return rows;
}

}  // namespace

void rowLabel(const char* label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label);
  ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + 7.6F * ImGui::GetFontSize());
  ImGui::SetNextItemWidth(-1);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  rowsOfFrame().push_back(
      {label, panelOfRows(), corner.x, corner.y, ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight()});
}

std::span<const RowPlace> rowPlaces() {
  return rowsOfFrame();
}

void markPanel(const char* title, bool open) {
  panelOfRows() = open ? title : "";
  const float at = ImGui::GetCursorScreenPos().y;
  if (open)
    panelsOfFrame().push_back({title, at, at});
  else
    panelsOfFrame().back().bottom = at;
}

std::span<const PanelPlace> panelPlaces() {
  return panelsOfFrame();
}

void forgetRows() {
  panelsOfFrame().clear();
  rowsOfFrame().clear();
}

bool choice(const char* id, int& index, std::span<const std::string_view> names) {
  bool changed = false;
  const auto at = static_cast<std::size_t>(index);
  const std::string current(at < names.size() ? names[at] : "");
  if (!ImGui::BeginCombo(id, current.c_str(), ImGuiComboFlags_HeightLarge)) return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool selected = static_cast<int>(i) == index;
    if (ImGui::Selectable(std::string(names[i]).c_str(), selected) && !selected) {
      index = static_cast<int>(i);
      changed = true;
    }
    if (selected) ImGui::SetItemDefaultFocus();
  }
  ImGui::EndCombo();
  return changed;
}

bool logSlider(const char* id, double& value, double low, double high, const char* format) {
  return ImGui::SliderScalar(id, ImGuiDataType_Double, &value, &low, &high, format, kLogSlider);
}

void faintText(std::string_view text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopStyleColor();
}

std::string fitted(std::string text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  const std::string ellipsis = "…";
  const auto continues = [&] {
    return !text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U;
  };
  while (!text.empty() && ImGui::CalcTextSize((text + ellipsis).c_str()).x > width) {
    while (continues()) text.pop_back();
    if (!text.empty()) text.pop_back();
  }
  return text + ellipsis;
}

float buttonWidth(int count) {
  const float gaps = static_cast<float>(count - 1) * ImGui::GetStyle().ItemSpacing.x;
  return (ImGui::GetContentRegionAvail().x - gaps) / static_cast<float>(count);
}

bool wallRows(BoundaryParameters& boundary) {
  rowLabel("Walls");
  auto handling = static_cast<int>(boundary.handling);
  bool changed = choice("##handling", handling, handlingNames());
  keyHint("/boundary/handling");
  boundary.handling = static_cast<BoundaryHandling>(handling);
  ImGui::BeginDisabled(boundary.handling != BoundaryHandling::gamma);
  rowLabel("Method of γ");
  changed |= choice("##method", boundary.gammaMethod, steppedGammaMethodNames());
  keyHint("/boundary/gamma/method");
  ImGui::EndDisabled();
  return changed;
}

bool maxIterationsRow(SolverParameters& solver) {
  rowLabel("Max iterations");
  const bool changed = ImGui::SliderInt("##max", &solver.maxIterations, 1, 100, "%d", kLogSlider);
  keyHint("/solver/max_iterations");
  if (changed) solver.minIterations = std::min(solver.minIterations, solver.maxIterations);
  return changed;
}

bool toleranceRow(SolverParameters& solver) {
  rowLabel("Tolerance");
  const bool changed = logSlider("##tolerance", solver.tolerance, 0.0005, 0.2, "%.4f");
  keyHint("/solver/tolerance");
  return changed;
}

namespace {

float textWidth(ImFont* font, const std::string& text) {
  return font->CalcTextSizeA(font->FontSize, 1e6F, 0, text.c_str()).x;
}

}  // namespace

LabelledTicks labelledTicks(const std::array<double, 2>& range, int most, float width, float beyond,
                            ImFont* font, const char* unit) {
  constexpr int kFewest = 2;
  LabelledTicks result;
  for (int wanted = most; wanted >= kFewest; --wanted) {
    const Ticks ticks = roundTicks(range[0], range[1], wanted);
    const bool tiny = ticks.decimals > 4 && std::max(std::abs(range[0]), std::abs(range[1])) < 1e-2;
    const std::string format = tiny ? "%.4g" : "%." + std::to_string(ticks.decimals) + "f";
    result = {ticks.values, {}};
    float widest = 0;
    for (const double value : ticks.values) {
      result.labels.push_back(formatNumber(format.c_str(), value) + unit);
      widest = std::max(widest, textWidth(font, result.labels.back()));
    }
    if (ticks.values.size() < 2) break;
    const auto apart = static_cast<float>((ticks.values[1] - ticks.values[0]) / (range[1] - range[0]));
    const float pushed = std::max(0.5F * widest - beyond, 0.0F);  // towards their neighbours, at the ends
    if (widest + pushed + 0.3F * font->FontSize <= apart * width) break;
  }
  return result;
}

void drawCaption(const Caption& caption, const Rect& area, const Fonts& fonts) {
  const float size = fonts.regular->FontSize;
  const float gap = std::round(0.7F * size), line = std::round(1.32F * size),
              padding = std::round(0.6F * size);
  float labels = 0, values = 0;
  for (const auto& [label, value] : caption.rows) {
    labels = std::max(labels, textWidth(fonts.regular, label));
    values = std::max(values, textWidth(fonts.regular, value));
  }
  const float width = std::max(textWidth(fonts.bold, caption.title), labels + gap + values);
  const auto rows = static_cast<float>(caption.rows.size() + (caption.title.empty() ? 0 : 1));

  ImDrawList* draw = ImGui::GetBackgroundDrawList();
  const ImVec2 corner{static_cast<float>(area.x) + padding, static_cast<float>(area.y) + padding};
  const ImVec2 end{std::ceil(corner.x + width + 2 * padding), corner.y + rows * line + padding};
  draw->AddRectFilled(corner, end, theme::kPaper, 0.35F * size);
  draw->AddRect(corner, end, theme::kPaperEdge, 0.35F * size);
  const float x = corner.x + padding;
  float y = corner.y + std::round(0.5F * padding + 0.5F * (line - size));
  if (!caption.title.empty()) {
    draw->AddText(fonts.bold, size, {x, y}, theme::kInk, caption.title.c_str());
    y += line;
  }
  for (const auto& [label, value] : caption.rows) {
    draw->AddText(fonts.regular, size, {x, y}, theme::kFaintInk, label.c_str());
    draw->AddText(fonts.regular, size, {std::round(x + labels + gap), y}, theme::kInk, value.c_str());
    y += line;
  }
}

namespace {

void drawMap(ImDrawList* draw, const ColorMap& colors, ImVec2 corner, float width, float height) {
  // One column a pixel: the map is shown as it is, without another interpolation on top.
  const int columns = static_cast<int>(width);
  for (int i = 0; i < columns; ++i) {
    const int entry =
        static_cast<int>(std::lround((kColorMapSize - 1) * static_cast<double>(i) / (columns - 1)));
    const Rgb8& c = colors[static_cast<std::size_t>(entry)];
    const float x = corner.x + static_cast<float>(i);
    draw->AddRectFilled({x, corner.y}, {x + 1, corner.y + height}, IM_COL32(c[0], c[1], c[2], 255));
  }
}

/// Lengths (pixels) that follow from the size of the text.
struct Layout {
  float size, margin, padding, barHeight, line, tickLength;

  explicit Layout(const Fonts& fonts)
      : size(fonts.regular->FontSize),
        margin(std::round(0.6F * size)),
        padding(std::round(0.7F * size)),
        barHeight(std::round(0.8F * size)),
        line(std::round(1.4F * size)),
        tickLength(std::round(0.3F * size)) {}
  float height() const { return line + barHeight + tickLength + line + std::round(0.9F * padding); }
};

}  // namespace

int legendHeight(const Fonts& fonts) {
  const Layout layout(fonts);
  return static_cast<int>(layout.height() + layout.margin);
}

void drawLegend(const ColorFieldInfo& field, const std::array<double, 2>& range, const ColorMap& colors,
                const Rect& area, const Fonts& fonts) {
  const auto [size, margin, padding, barHeight, line, tickLength] = Layout(fonts);
  const float room = static_cast<float>(area.width) - 2 * (margin + padding);
  const float barWidth = std::floor(std::min(17 * size, room));
  if (barWidth < 4 * size) return;

  const ImVec2 end{static_cast<float>(area.x + area.width) - margin,
                   static_cast<float>(area.y + area.height) - margin};
  const ImVec2 corner{end.x - barWidth - 2 * padding, end.y - Layout(fonts).height()};
  ImDrawList* draw = ImGui::GetBackgroundDrawList();
  draw->AddRectFilled(corner, end, theme::kPaper, 0.35F * size);
  draw->AddRect(corner, end, theme::kPaperEdge, 0.35F * size);

  const ImVec2 bar{corner.x + padding, corner.y + std::round(0.45F * padding) + line};
  const std::string label = field.label + (field.unit.empty() ? "" : "  (" + field.unit + ")");
  draw->AddText(fonts.regular, size, {bar.x, bar.y - line + 1}, theme::kInk, label.c_str());
  drawMap(draw, colors, bar, barWidth, barHeight);

  const auto [values, labels] = labelledTicks(range, 6, barWidth, padding - 2, fonts.regular);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double share = (values[k] - range[0]) / (range[1] - range[0]);
    const float x = std::floor(bar.x + static_cast<float>(share) * (barWidth - 1));
    draw->AddRectFilled({x, bar.y + barHeight}, {x + 1, bar.y + barHeight + tickLength}, theme::kFaintInk);
    const float width = textWidth(fonts.regular, labels[k]);
    const float left = std::clamp(x - 0.5F * width, corner.x + 2, end.x - width - 2);
    draw->AddText(fonts.regular, size, {std::round(left), bar.y + barHeight + tickLength}, theme::kInk,
                  labels[k].c_str());
  }
}

}  // namespace migiwa
