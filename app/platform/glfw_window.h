// A window with an OpenGL 4.5 core context.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "app/platform/gl_context.h"
#include "app/platform/input_state.h"

namespace migiwa {

class GlfwWindow final : public GlContext {
 public:
  /// Opens it and makes its context current. Throws MissingError when there is no display or no OpenGL 4.5.
  GlfwWindow(const std::string& title, int width, int height);
  ~GlfwWindow() override;
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  std::string renderer() const override;

  bool shouldClose() const;
  /// Waits at most `seconds` for something to happen, then says what happened since the last call.
  InputState waitForInput(double seconds);
  /// Whether the last call of waitForInput() saw anything, a resize or an uncovered window included.
  bool somethingHappened() const;
  /// Width and height of what is drawn into (pixels).
  std::array<int, 2> framebufferSize() const;
  /// Pixels over those of an ordinary screen.
  double contentScale() const;
  /// Shows what was drawn.
  void swap();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace migiwa
