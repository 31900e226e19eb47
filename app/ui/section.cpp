// The panel of the section, and the value under the mouse.
#include <algorithm>
#include <array>
#include <string>

#include "app/ui/ui.h"
#include "app/ui/widgets.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

constexpr std::array<std::string_view, 4> kPlaneNames{"across x", "across y", "across z", "at an angle"};
constexpr std::array<std::string_view, 3> kDividedNames{"by the kernel's sum", "by γ", "by nothing"};

/// Where planes of a direction meet the bounds, from and to (m along it).
std::array<double, 2> reachAlong(const Vec3d& direction, const Bounds& bounds) {
  const double middle = direction.dot(bounds.center()), half = 0.5 * direction.cwiseAbs().dot(bounds.size());
  return {middle - half, middle + half};
}

void planeRows(SectionView& view, const Bounds& bounds, const Vec3d& origin) {
  rowLabel("Plane");
  int plane = view.free ? 3 : static_cast<int>(view.axis);
  if (choice("##section_plane", plane, kPlaneNames)) {
    view.free = plane == 3;
    if (!view.free) view.axis = static_cast<Axis>(plane);
    view.at = view.direction().dot(bounds.center());
  }
  if (view.free) {
    rowLabel("Normal");
    constexpr double kLow = -1, kHigh = 1;
    std::array<double, 3> normal{view.normal.x(), view.normal.y(), view.normal.z()};
    if (ImGui::SliderScalarN("##section_normal", ImGuiDataType_Double, normal.data(), 3, &kLow, &kHigh,
                             "%.2f", ImGuiSliderFlags_AlwaysClamp)) {
      const Vec3d turned(normal[0], normal[1], normal[2]);
      // About the place where it was, as far as the middle of the scene is concerned.
      const double above = view.at - view.direction().dot(bounds.center());
      if (turned.norm() > 0.05) view.normal = turned;
      view.at = view.direction().dot(bounds.center()) + above;
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Of any length but zero");
  }
  rowLabel("At");
  const double shift = view.direction().dot(origin);
  const auto [from, to] = reachAlong(view.direction(), bounds);
  const double low = from + shift, high = to + shift;
  double at = view.at + shift;
  if (ImGui::SliderScalar("##section_at", ImGuiDataType_Double, &at, &low, &high, "%.4f m"))
    view.at = at - shift;
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("Along the normal, in m. Control and the wheel over the picture move it, too");
}

}  // namespace

void sectionPanel(PanelModel& model) {
  SectionView& view = model.view.section;
  SectionModel& section = *model.section;
  rowLabel("Show");
  ImGui::Checkbox("##section", &view.shown);
  ImGui::BeginDisabled(!view.shown);
  ImGui::SameLine();
  ImGui::Checkbox("Cut away", &view.cut);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("What is before the plane, in place of the view's cut");
  rowLabel("Colours");
  ImGui::Checkbox("Lines", &view.lines);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Lines of equal values");
  ImGui::SameLine();
  ImGui::Checkbox("Fit", &view.fit);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("From the least to the largest value that there is");
  rowLabel("Field");
  int field = static_cast<int>(view.field);
  if (choice("##section_field", field, kSectionFieldNames)) view.field = static_cast<SectionField>(field);
  rowLabel("Divided");
  ImGui::BeginDisabled(!isInterpolated(view.field));
  int divisor = static_cast<int>(view.divisor);
  if (choice("##section_divisor", divisor, kDividedNames))
    view.divisor = static_cast<SectionDivisor>(divisor);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("The sum over the particles is short of what walls take, unless it is divided");
  ImGui::EndDisabled();
  planeRows(view, model.bounds, model.scene.origin);

  ImGui::BeginDisabled(!section.raster);
  if (ImGui::Button("Save as CSV", {buttonWidth(2), 0})) model.commands.saveSection = true;
  ImGui::EndDisabled();
  ImGui::EndDisabled();
  if (!view.shown) return;
  const auto beside = [](const std::string& note) {
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    faintText(note);
  };
  if (!section.fault.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, theme::alert());
    ImGui::TextWrapped("%s", section.fault.c_str());
    ImGui::PopStyleColor();
  } else if (!section.raster) {
    beside("being worked out ...");
  } else if (section.time != model.frame.time) {
    beside(formatNumber("as at %.3f s", section.time));
  }
}

void sectionPointer(const SectionModel& model, const ColorFieldInfo& info, const Vec3d& origin) {
  if (!model.pointed || !model.raster) return;
  const std::optional<float> value = model.raster->at(*model.pointed);
  if (!value) return;
  const Vec3d at = *model.pointed + origin;
  ImGui::BeginTooltip();
  ImGui::Text("%s  %.5g %s", info.label.c_str(), static_cast<double>(*value), info.unit.c_str());
  ImGui::Text("at  %.3f  %.3f  %.3f m", at.x(), at.y(), at.z());
  ImGui::EndTooltip();
}

}  // namespace migiwa
