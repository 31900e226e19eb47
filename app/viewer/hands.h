// Hands at a window that is none: mouse and keyboard, frame by frame.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "app/platform/context.h"

namespace migiwa {

class Hands {
 public:
  using Place = std::array<float, 2>;  ///< (pixels)
  /// Keys that are held meanwhile, and which button it is.
  struct Held {
    bool control = false, shift = false;
    MouseButton button = MouseButton::left;
  };

  /// `frame` draws one.
  explicit Hands(std::function<void(const InputState&)> frame) : frame_(std::move(frame)) {}

  /// Frames without input.
  void look(int frames = 3);
  void moveTo(const Place& place);
  /// Moves there, presses, and lets go.
  void click(const Place& place, const Held& held) { drag(place, place, held); }
  void doubleClick(const Place& place);
  void drag(const Place& from, const Place& to, const Held& held);
  void press(Key key, const Held& held);
  void type(const std::string& text);
  void wheel(const Place& place, float notches, const Held& held);

 private:
  std::function<void(const InputState&)> frame_;
};

}  // namespace migiwa
