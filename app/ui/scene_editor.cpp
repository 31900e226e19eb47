#include <algorithm>

#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "app/render/projection.h"
#include "app/session/ui_state.h"
#include "app/ui/widgets.h"

namespace migiwa {
namespace {

constexpr ImU32 kFaultyLine = IM_COL32(255, 143, 115, 46);
constexpr ImU32 kCaretLine = IM_COL32(128, 140, 150, 30);
constexpr int kMostListed = 6;

/// Where a line, counted from 1, begins.
int offsetOfLine(const std::string& text, int line) {
  std::size_t at = 0;
  for (int k = 1; k < line; ++k) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    at = end + 1;
  }
  return static_cast<int>(at);
}

int onCaret(ImGuiInputTextCallbackData* data) {
  auto& editor = *static_cast<SceneEditor*>(data->UserData);
  if (editor.goTo > 0) {
    const std::string text(data->Buf, data->Buf + data->BufTextLen);
    data->CursorPos = data->SelectionStart = data->SelectionEnd = offsetOfLine(text, editor.goTo);
    editor.goTo = 0;
  }
  editor.caretLine = 1 + static_cast<int>(std::count(data->Buf, data->Buf + data->CursorPos, '\n'));
  return 0;
}

/// Line numbers, and a band behind each faulty line. Only what is in sight is drawn.
void drawLines(const SceneEditor& editor, ImVec2 origin, float lineHeight, float gutter, int count) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float top = ImGui::GetScrollY(), right = origin.x + ImGui::GetWindowWidth() + ImGui::GetScrollX();
  const int first = std::max(1, static_cast<int>(top / lineHeight));
  const int last = std::min(count, first + static_cast<int>(ImGui::GetWindowHeight() / lineHeight) + 2);
  for (int line = first; line <= last; ++line) {
    const float y = origin.y + static_cast<float>(line - 1) * lineHeight;
    const bool faulty = std::any_of(editor.faults.begin(), editor.faults.end(),
                                    [&](const SceneEditor::Fault& fault) { return fault.line == line; });
    if (line == editor.caretLine) draw.AddRectFilled({origin.x, y}, {right, y + lineHeight}, kCaretLine);
    if (faulty) {
      draw.AddRectFilled({origin.x, y}, {right, y + lineHeight}, kFaultyLine);
      draw.AddRectFilled({origin.x, y}, {origin.x + 3, y + lineHeight}, theme::alert());
    }
    const std::string number = std::to_string(line);
    const float width = ImGui::CalcTextSize(number.c_str()).x;
    draw.AddText({origin.x + gutter - width - 0.6F * lineHeight, y},
                 faulty ? theme::alert() : ImGui::GetColorU32(ImGuiCol_TextDisabled), number.c_str());
  }
}

/// Gives the text of several lines that comes next the keyboard.
void focusText([[maybe_unused]] const char* name) {
#if IMGUI_VERSION_NUM >= 19000
  // There SetKeyboardFocusHere() does not reach a text of several lines.
  ImGui::ActivateItemByID(ImGui::GetID(name));
#else
  ImGui::SetKeyboardFocusHere();
#endif
}

/// The text is as high as its lines, inside a part that scrolls, so that lines and their numbers move as one.
void textWithLines(SceneEditor& editor, float height, ImFont* mono) {
  ImGui::PushStyleColor(ImGuiCol_ChildBg, theme::well());
  ImGui::BeginChild("##lines", {0, height});
  ImGui::PushFont(mono);
  const float lineHeight = ImGui::GetFontSize();
  const int count = 1 + static_cast<int>(std::count(editor.text.begin(), editor.text.end(), '\n'));
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  const float padding = ImGui::GetStyle().FramePadding.y;
  const float gutter = ImGui::CalcTextSize("000").x + 1.2F * lineHeight;
  drawLines(editor, {origin.x, origin.y + padding}, lineHeight, gutter, count);

  ImGui::SetCursorScreenPos({origin.x + gutter, origin.y});
  const float needed = static_cast<float>(count + 1) * lineHeight + 2 * padding;
  const ImVec2 size{ImGui::GetContentRegionAvail().x, std::max(needed, ImGui::GetContentRegionAvail().y)};
  const int before = editor.caretLine;
  ImGui::PushID(editor.generation);
  if (editor.wantsFocus) focusText("##text");
  ImGui::PushStyleColor(ImGuiCol_FrameBg, IM_COL32_BLACK_TRANS);
  ImGui::InputTextMultiline("##text", &editor.text, size,
                            ImGuiInputTextFlags_CallbackAlways | ImGuiInputTextFlags_AllowTabInput, onCaret,
                            &editor);
  ImGui::PopStyleColor();
  ImGui::PopID();
  editor.active = ImGui::IsItemActive();
  editor.wantsFocus = false;
  if (editor.caretLine != before) {
    const float y = padding + static_cast<float>(editor.caretLine - 1) * lineHeight;
    if (y < ImGui::GetScrollY()) ImGui::SetScrollY(y);
    if (y + 2 * lineHeight > ImGui::GetScrollY() + height) ImGui::SetScrollY(y + 2 * lineHeight - height);
  }
  ImGui::PopFont();
  ImGui::EndChild();
  ImGui::PopStyleColor();
}

/// A click moves the caret to the line.
void faultList(SceneEditor& editor, float height) {
  ImGui::BeginChild("##faults", {0, height});
  ImGui::PushStyleColor(ImGuiCol_Text, theme::alert());
  for (std::size_t k = 0; k < editor.faults.size(); ++k) {
    const SceneEditor::Fault& fault = editor.faults[k];
    const std::string shown =
        (fault.line > 0 ? "line " + std::to_string(fault.line) + "  " : "") + fault.message;
    ImGui::PushID(static_cast<int>(k));
    const ImVec2 at = ImGui::GetCursorPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float rows = ImGui::CalcTextSize(shown.c_str(), nullptr, false, width).y;
    if (ImGui::Selectable("##fault", false, 0, {width, rows}) && fault.line > 0) {
      editor.goTo = fault.line;
      editor.wantsFocus = true;
    }
    ImGui::SetCursorPos(at);
    ImGui::TextWrapped("%s", shown.c_str());
    ImGui::PopID();
  }
  ImGui::PopStyleColor();
  ImGui::EndChild();
}

void buttons(SceneEditor& editor) {
  const float width = 5.6F * ImGui::GetFontSize();
  if (ImGui::Button("Apply", {width, 0})) editor.apply = true;
  ImGui::SameLine();
  ImGui::BeginDisabled(!editor.edited());
  if (ImGui::Button("Revert", {width, 0})) editor.revert = true;
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (ImGui::Button("Save as", {width, 0})) editor.save = true;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  ImGui::InputText("##name", &editor.saveName);
}

}  // namespace

void sceneEditorWindow(SceneEditor& editor, const Rect& area, const Fonts& fonts) {
  if (!editor.open) return;
  const float text = ImGui::GetFontSize();
  const float width = std::min(0.62F * static_cast<float>(area.width), 44 * text);
  const float margin = 0.8F * text;
  ImGui::SetNextWindowPos({static_cast<float>(area.x + area.width) - width - margin, margin},
                          ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({width, static_cast<float>(area.height) - 2 * margin}, ImGuiCond_FirstUseEver);
  const std::string title = editor.fileName + (editor.edited() ? " (edited)" : "") + "###editor";
  const ImVec4 bar = ImGui::GetStyleColorVec4(ImGuiCol_Header);
  ImGui::PushStyleColor(ImGuiCol_TitleBg, bar);
  ImGui::PushStyleColor(ImGuiCol_TitleBgActive, bar);
  ImGui::PushStyleColor(ImGuiCol_ResizeGrip, bar);
  if (ImGui::Begin(title.c_str(), &editor.open,
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse)) {
    const float row = ImGui::GetFrameHeightWithSpacing();
    const auto listed = static_cast<float>(std::min<std::size_t>(editor.faults.size(), kMostListed));
    const float list = listed > 0 ? 1.6F * listed * ImGui::GetTextLineHeightWithSpacing() : 0;
    const float below = list + (listed > 0 ? ImGui::GetStyle().ItemSpacing.y : 0) + 2 * row;
    textWithLines(editor, std::max(4 * row, ImGui::GetContentRegionAvail().y - below), fonts.mono);
    if (listed > 0) faultList(editor, list);
    faintText(editor.note);
    buttons(editor);
  }
  ImGui::End();
  ImGui::PopStyleColor(3);
}

}  // namespace migiwa
