// The gallery: what can be opened, with pictures and descriptions, a click away.
#include <algorithm>
#include <cmath>
#include <string>

#include <imgui.h>
#include <imgui_stdlib.h>

#include "app/ui/widgets.h"

namespace migiwa {
namespace {

constexpr float kCard = 15;            // least width over the height of the text
constexpr float kPicture = 9.0F / 16;  // height over width
constexpr float kDescription = 2.7F;   // lines

/// Returns whether it was clicked.
bool card(const GalleryEntry& entry, const Fonts& fonts, float width) {
  const float text = ImGui::GetFontSize(), gap = std::round(0.4F * text);
  const float picture = std::round(kPicture * width);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 size{width, picture + 1.5F * text + kDescription * text};
  const bool clicked = ImGui::InvisibleButton(entry.file.c_str(), size);
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const ImVec2 end{corner.x + size.x, corner.y + size.y};
  draw->AddRectFilled(corner, end, ImGui::GetColorU32(hovered ? ImGuiCol_HeaderHovered : ImGuiCol_Header), 4);
  if (entry.texture != 0) {
    draw->AddImage(reinterpret_cast<ImTextureID>(entry.texture), corner, {end.x, corner.y + picture});
  } else {
    draw->AddRectFilled(corner, {end.x, corner.y + picture}, theme::well(), 4);
    draw->AddText({corner.x + gap, corner.y + gap}, ImGui::GetColorU32(ImGuiCol_TextDisabled), "no picture");
  }
  if (hovered) draw->AddRect(corner, end, theme::accent(), 4, 0, 2);
  const float y = corner.y + picture + std::round(0.2F * text);
  draw->PushClipRect(corner, {end.x - gap, end.y - 2}, true);
  draw->AddText(fonts.bold, text, {corner.x + gap, y}, ImGui::GetColorU32(ImGuiCol_Text), entry.name.c_str());
  const float small = std::round(0.86F * text);
  draw->AddText(fonts.regular, small, {corner.x + gap, y + 1.25F * text},
                ImGui::GetColorU32(ImGuiCol_TextDisabled), entry.description.c_str(), nullptr,
                width - 2 * gap);
  draw->PopClipRect();
  if (hovered) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(28 * text);
    ImGui::TextUnformatted(entry.description.c_str());
    faintText(entry.file.string());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }
  return clicked;
}

void cards(GalleryModel& model, bool recent, const Fonts& fonts) {
  const float spacing = ImGui::GetStyle().ItemSpacing.x, room = ImGui::GetContentRegionAvail().x;
  const float least = kCard * ImGui::GetFontSize();
  const int columns = std::max(1, static_cast<int>((room + spacing) / (least + spacing)));
  const float width = std::floor((room + spacing) / static_cast<float>(columns) - spacing);
  int k = 0;
  ImGui::PushID(recent ? "recent" : "shipped");
  for (const GalleryEntry& entry : model.entries) {
    if (entry.recent != recent) continue;
    if (k++ % columns != 0) ImGui::SameLine();
    if (card(entry, fonts, width)) model.ask = entry.file;
  }
  ImGui::PopID();
}

void heading(const char* title, ImFont* bold) {
  ImGui::PushFont(bold);
  ImGui::TextUnformatted(title);
  ImGui::PopFont();
}

/// The name of a file to open, and what became of the last one.
void fileRow(GalleryModel& model) {
  const float width = 5.6F * ImGui::GetFontSize();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - width - ImGui::GetStyle().ItemSpacing.x);
  const bool entered = ImGui::InputTextWithHint(
      "##file", "a scene, mesh, points or SLIM file; it can be dropped on the window, too", &model.typed,
      ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  ImGui::BeginDisabled(model.typed.empty());
  if (ImGui::Button("Open", {width, 0}) || (entered && !model.typed.empty())) model.ask = model.typed;
  ImGui::EndDisabled();
  if (!model.opening.empty()) {
    ImGui::TextWrapped("Opening %s", model.opening.c_str());
    ImGui::SameLine();
    if (ImGui::SmallButton("Cancel")) model.cancel = true;
  }
  if (model.faults.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, theme::alert());
  for (const std::string& fault : model.faults) ImGui::TextWrapped("%s", fault.c_str());
  ImGui::PopStyleColor();
}

}  // namespace

void galleryWindow(GalleryModel& model, const Rect& area, const Fonts& fonts) {
  if (!model.open) return;
  const float margin = std::round(0.8F * ImGui::GetFontSize());
  ImGui::SetNextWindowPos({static_cast<float>(area.x) + margin, static_cast<float>(area.y) + margin});
  ImGui::SetNextWindowSize(
      {static_cast<float>(area.width) - 2 * margin, static_cast<float>(area.height) - 2 * margin});
  const ImVec4 bar = ImGui::GetStyleColorVec4(ImGuiCol_Header);
  ImGui::PushStyleColor(ImGuiCol_TitleBg, bar);
  ImGui::PushStyleColor(ImGuiCol_TitleBgActive, bar);
  if (ImGui::Begin("Scenes###gallery", &model.open,
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) {
    fileRow(model);
    const auto isRecent = [](const GalleryEntry& entry) { return entry.recent; };
    ImGui::BeginChild("##cards");
    if (std::any_of(model.entries.begin(), model.entries.end(), isRecent)) {
      heading("Opened last", fonts.bold);
      cards(model, true, fonts);
    }
    heading("Shipped with the program", fonts.bold);
    cards(model, false, fonts);
    ImGui::EndChild();
  }
  ImGui::End();
  ImGui::PopStyleColor(2);
}

}  // namespace migiwa
