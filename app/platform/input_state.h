// What mouse and keyboard did since the last frame, in words of our own: the window fills it in, an
// off-screen run leaves it empty.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace migiwa {

enum class Key {
  tab,
  left,
  right,
  up,
  down,
  home,
  end,
  insert,
  remove,
  backspace,
  enter,
  escape,
  space,
  a,
  c,
  h,
  p,
  r,
  v,
  x,
  y,
  z,
};
inline constexpr std::size_t kKeyCount = static_cast<std::size_t>(Key::z) + 1;

enum class MouseButton { left, right, middle };
inline constexpr std::size_t kMouseButtonCount = 3;

struct InputState {
  bool mouseInside = false;
  float mouseX = 0, mouseY = 0;  ///< pixels of the picture, from the top left
  std::array<bool, kMouseButtonCount> buttons{};
  float wheel = 0;  ///< notches since the last frame
  std::array<bool, kKeyCount> keys{};
  bool control = false, shift = false, alt = false;
  std::vector<unsigned> characters;  ///< typed since the last frame
  double seconds = 1.0 / 60;         ///< since the last frame; for blinking and double clicks only

  bool down(MouseButton button) const { return buttons[static_cast<std::size_t>(button)]; }
  bool down(Key key) const { return keys[static_cast<std::size_t>(key)]; }
};

}  // namespace migiwa
