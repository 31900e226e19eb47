// What keys and the mouse do in the window: one table, which whoever carries it out, the list in the window
// and `migiwa view --help` all read.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/platform/context.h"

namespace migiwa {

enum class KeyAction {
  playOrPause,
  step,
  stepBack,
  toStart,
  toEnd,
  reset,
  correct,
  panels,
  picture,
  undo,
  redo,
  close,
  keys,
};

struct KeyBinding {
  KeyAction action;
  std::string_view does;
  std::optional<Key> key{};  ///< nothing: the character
  char character = 0;        ///< wherever the keyboard has it
  bool control = false;
  std::optional<bool> shift{};  ///< nothing: with it or without
};

/// In the order in which people read them.
std::span<const KeyBinding> keyBindings();
/// Such as "Control + Z".
std::string nameOf(const KeyBinding& binding);
/// Those whose keys went down between two frames, none twice.
std::vector<KeyAction> pressedActions(const InputState& before, const InputState& now);

enum class MouseGesture { drag, click, doubleClick, wheel, point };
enum class MouseAction { turn, move, select, lookAt, zoom, moveSection, pick, point };

struct MouseBinding {
  MouseAction action;
  std::string_view does;
  MouseGesture gesture;
  std::optional<MouseButton> button{};  ///< of a drag or a click
  /// Nothing: with it or without.
  std::optional<bool> control{}, shift{};
};

/// The first that fits counts.
std::span<const MouseBinding> mouseBindings();
/// Such as "Shift + left drag".
std::string nameOf(const MouseBinding& binding);
/// What a gesture over the picture asks for, with the keys of `input` held.
std::optional<MouseAction> actionOf(MouseGesture gesture, std::optional<MouseButton> button,
                                    const InputState& input);

/// Both tables as lines of text, for --help.
std::string bindingsText();

}  // namespace migiwa
