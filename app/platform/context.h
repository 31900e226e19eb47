// OpenGL contexts, off-screen or a window's, what mouse and keyboard did, and the functions of OpenGL.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <glad/gl.h>

namespace migiwa {

// An OpenGL 4.5 core context, off-screen or a window's: all that drawing needs to know of either.

class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Driver and version, such as "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
  virtual std::string renderer() const = 0;
};

// An off-screen context through EGL: no display, no window, no surface.

/// Makes a context and makes it current. Throws MissingError with what to install when this machine has none.
std::unique_ptr<GlContext> makeEglContext();

// What mouse and keyboard did since the last frame, in words of our own: the window fills it in, an
// off-screen run leaves it empty.

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
  f1,
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
  std::vector<std::string> dropped;  ///< names of files that were dropped on the window since then
  double seconds = 1.0 / 60;         ///< since the last frame; for blinking and double clicks only

  bool down(MouseButton button) const { return buttons[static_cast<std::size_t>(button)]; }
  bool down(Key key) const { return keys[static_cast<std::size_t>(key)]; }
};

/// Where text is copied to and pasted from.
struct Clipboard {
  std::function<void(const std::string&)> set;
  std::function<std::string()> get;
};

// A window with an OpenGL 4.5 core context.

class GlfwWindow final : public GlContext {
 public:
  /// Opens it and makes its context current. Throws MissingError when there is no display or no OpenGL 4.5.
  GlfwWindow(const std::string& title, int width, int height);
  ~GlfwWindow() override;
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  std::string renderer() const override;

  bool shouldClose() const;
  void setTitle(const std::string& title);
  /// Waits at most `seconds` for something to happen, then says what happened since the last call.
  InputState waitForInput(double seconds);
  /// Whether the last call of waitForInput() saw anything, a resize or an uncovered window included.
  bool somethingHappened() const;
  /// Width and height of what is drawn into (pixels).
  std::array<int, 2> framebufferSize() const;
  /// Pixels over those of an ordinary screen.
  double contentScale() const;
  /// Waits until all is drawn.
  void finish();
  /// Shows what was drawn.
  void swap();
  /// That of the desktop; lasts no longer than the window.
  Clipboard clipboard() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// OpenGL 4.5 core, loaded once a context is current. Only app/render and app/platform include this.

using GlProc = void (*)();
using GlProcLoader = GlProc (*)(const char* name);

/// Loads the functions of the current context; throws MissingError when it is older than OpenGL 4.5.
void loadGl(GlProcLoader loader);

/// Driver and version of the current context.
std::string describeGl();

}  // namespace migiwa
