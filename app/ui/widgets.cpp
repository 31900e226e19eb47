#include "app/ui/widgets.h"

#include <algorithm>
#include <cctype>

namespace migiwa {

std::string titleOf(std::string_view key) {
  std::string title(key);
  std::replace(title.begin(), title.end(), '_', ' ');
  if (!title.empty()) title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

void rowLabel(const char* label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label);
  ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + 7.6F * ImGui::GetFontSize());
  ImGui::SetNextItemWidth(-1);
}

bool choice(const char* id, int& index, std::span<const std::string_view> names) {
  bool changed = false;
  const auto at = static_cast<std::size_t>(index);
  const std::string current(at < names.size() ? names[at] : "");
  if (!ImGui::BeginCombo(id, current.c_str())) return false;
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

float buttonWidth(int count) {
  const float gaps = static_cast<float>(count - 1) * ImGui::GetStyle().ItemSpacing.x;
  return (ImGui::GetContentRegionAvail().x - gaps) / static_cast<float>(count);
}

}  // namespace migiwa
