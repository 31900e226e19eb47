#include "app/ui/bindings.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <imgui.h>

#include "app/ui/widgets.h"

namespace migiwa {
namespace {

constexpr auto kKeyBindings = std::to_array<KeyBinding>({
    {.action = KeyAction::playOrPause, .does = "plays and pauses", .key = Key::space},
    {.action = KeyAction::step, .does = "a frame on", .key = Key::right},
    {.action = KeyAction::stepBack, .does = "a frame back", .key = Key::left},
    {.action = KeyAction::toStart, .does = "to the start of the branch on the time line", .key = Key::home},
    {.action = KeyAction::toEnd, .does = "to its end", .key = Key::end},
    {.action = KeyAction::reset, .does = "begins anew and forgets the past", .key = Key::r},
    {.action = KeyAction::correct, .does = "corrects at walls, or not", .key = Key::c},
    {.action = KeyAction::panels, .does = "hides the panels, or shows them", .key = Key::h},
    {.action = KeyAction::picture,
     .does = "saves a picture here as migiwa_0001.png and so on",
     .key = Key::p},
    {.action = KeyAction::undo,
     .does = "takes a change back",
     .key = Key::z,
     .control = true,
     .shift = false},
    {.action = KeyAction::redo, .does = "does it again", .key = Key::y, .control = true},
    {.action = KeyAction::redo, .does = "the same", .key = Key::z, .control = true, .shift = true},
    {.action = KeyAction::close,
     .does = "closes this list or the command, lets go of particles",
     .key = Key::escape},
    {.action = KeyAction::keys, .does = "lists keys and mouse, or hides the list", .character = '?'},
    {.action = KeyAction::keys, .does = "the same", .key = Key::f1},
});

constexpr auto kMouseBindings = std::to_array<MouseBinding>({
    {.action = MouseAction::move,
     .does = "moves the view",
     .gesture = MouseGesture::drag,
     .button = MouseButton::left,
     .shift = true},
    {.action = MouseAction::select,
     .does = "selects the particles in a rectangle",
     .gesture = MouseGesture::drag,
     .button = MouseButton::left,
     .control = true},
    {.action = MouseAction::turn,
     .does = "turns it",
     .gesture = MouseGesture::drag,
     .button = MouseButton::left},
    {.action = MouseAction::move,
     .does = "moves it",
     .gesture = MouseGesture::drag,
     .button = MouseButton::right},
    {.action = MouseAction::move,
     .does = "moves it",
     .gesture = MouseGesture::drag,
     .button = MouseButton::middle},
    {.action = MouseAction::moveSection,
     .does = "moves the section, where one is shown",
     .gesture = MouseGesture::wheel,
     .control = true},
    {.action = MouseAction::zoom, .does = "comes nearer", .gesture = MouseGesture::wheel},
    {.action = MouseAction::lookAt,
     .does = "looks at the place",
     .gesture = MouseGesture::doubleClick,
     .button = MouseButton::left},
    {.action = MouseAction::pick,
     .does = "looks into the particle",
     .gesture = MouseGesture::click,
     .button = MouseButton::left},
    {.action = MouseAction::point,
     .does = "tells of a particle, or of the section",
     .gesture = MouseGesture::point},
});

std::string_view keyName(Key key) {
  switch (key) {
    case Key::space:
      return "Space";
    case Key::right:
      return "Right arrow";
    case Key::left:
      return "Left arrow";
    case Key::home:
      return "Home";
    case Key::end:
      return "End";
    case Key::escape:
      return "Escape";
    case Key::f1:
      return "F1";
    case Key::c:
      return "C";
    case Key::h:
      return "H";
    case Key::p:
      return "P";
    case Key::r:
      return "R";
    case Key::y:
      return "Y";
    case Key::z:
      return "Z";
    default:
      return "";  // bound to nothing
  }
}

std::string_view gestureName(MouseGesture gesture) {
  switch (gesture) {
    case MouseGesture::drag:
      return "drag";
    case MouseGesture::click:
      return "click";
    case MouseGesture::doubleClick:
      return "double click";
    case MouseGesture::wheel:
      return "wheel";
    default:
      return "point";
  }
}

std::string_view buttonName(MouseButton button) {
  return button == MouseButton::left ? "left " : button == MouseButton::right ? "right " : "middle ";
}

bool fits(bool control, std::optional<bool> shift, const InputState& input) {
  return control == input.control && shift.value_or(input.shift) == input.shift;
}

void rows(const auto& bindings) {
  for (const auto& binding : bindings) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(nameOf(binding).c_str());
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(binding.does.data(), binding.does.data() + binding.does.size());
  }
}

}  // namespace

std::span<const KeyBinding> keyBindings() {
  return kKeyBindings;
}

std::span<const MouseBinding> mouseBindings() {
  return kMouseBindings;
}

std::string nameOf(const KeyBinding& binding) {
  std::string name = binding.control ? "Control + " : "";
  if (binding.shift.value_or(false)) name += "Shift + ";
  return binding.key ? name + std::string(keyName(*binding.key)) : name + binding.character;
}

std::string nameOf(const MouseBinding& binding) {
  std::string name = binding.control.value_or(false) ? "control + " : "";
  if (binding.shift.value_or(false)) name += "shift + ";
  if (binding.button) name += buttonName(*binding.button);
  name += gestureName(binding.gesture);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

std::vector<KeyAction> pressedActions(const InputState& before, const InputState& now) {
  std::vector<KeyAction> actions;
  for (const KeyBinding& binding : kKeyBindings) {
    bool pressed = false;
    if (binding.key) {
      pressed = !now.alt && fits(binding.control, binding.shift, now) && now.down(*binding.key) &&
                !before.down(*binding.key);
    } else {
      pressed = std::find(now.characters.begin(), now.characters.end(),
                          static_cast<unsigned>(binding.character)) != now.characters.end();
    }
    if (pressed && std::find(actions.begin(), actions.end(), binding.action) == actions.end())
      actions.push_back(binding.action);
  }
  return actions;
}

std::optional<MouseAction> actionOf(MouseGesture gesture, std::optional<MouseButton> button,
                                    const InputState& input) {
  for (const MouseBinding& binding : kMouseBindings) {
    if (binding.gesture == gesture && binding.button == button &&
        binding.control.value_or(input.control) == input.control &&
        binding.shift.value_or(input.shift) == input.shift)
      return binding.action;
  }
  return std::nullopt;
}

std::string bindingsText() {
  constexpr std::size_t kColumn = 22;
  std::string text;
  const auto add = [&](const char* heading, const auto& bindings) {
    text += heading;
    for (const auto& binding : bindings) {
      std::string name = nameOf(binding);
      name.resize(std::max(kColumn, name.size() + 1), ' ');
      text += "\n  " + name + std::string(binding.does);
    }
  };
  add("Keys:", kKeyBindings);
  add("\nMouse over the picture:", kMouseBindings);
  return text;
}

void bindingsWindow(bool& open, const Rect& area) {
  if (!open) return;
  const float text = ImGui::GetFontSize(), margin = std::round(0.8F * text);
  const ImVec2 corner{static_cast<float>(area.x + area.width) - margin, static_cast<float>(area.y) + margin};
  ImGui::SetNextWindowPos(corner, ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowSizeConstraints(
      {0, 0}, {static_cast<float>(area.width) - 2 * margin, static_cast<float>(area.height) - 2 * margin});
  const ImVec4 bar = ImGui::GetStyleColorVec4(ImGuiCol_Header);
  ImGui::PushStyleColor(ImGuiCol_TitleBg, bar);
  ImGui::PushStyleColor(ImGuiCol_TitleBgActive, bar);
  if (ImGui::Begin("Keys and mouse###bindings", &open,
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                       ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing)) {
    // Where there is less room than the lists are wide, lines break.
    ImGui::PushTextWrapPos(static_cast<float>(area.width) - 4 * margin - ImGui::GetStyle().ScrollbarSize);
    // Both lists are of one width.
    if (ImGui::BeginTable("bindings", 2, ImGuiTableFlags_SizingFixedFit)) {
      rows(kKeyBindings);
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      faintText("Over the picture");
      rows(kMouseBindings);
      ImGui::EndTable();
    }
    faintText("While text is being typed, keys belong to it.");
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
  ImGui::PopStyleColor(2);
}

}  // namespace migiwa
