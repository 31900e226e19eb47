// GLFW is included here and nowhere else.
#include "app/platform/context.h"

#define GLFW_INCLUDE_NONE
#include <algorithm>
#include <utility>

#include <GLFW/glfw3.h>

#include "core/base/messages.h"

namespace migiwa {
namespace {

constexpr std::array<int, kKeyCount> kGlfwKeys{
    GLFW_KEY_TAB,   GLFW_KEY_LEFT,   GLFW_KEY_RIGHT,  GLFW_KEY_UP,        GLFW_KEY_DOWN,  GLFW_KEY_HOME,
    GLFW_KEY_END,   GLFW_KEY_INSERT, GLFW_KEY_DELETE, GLFW_KEY_BACKSPACE, GLFW_KEY_ENTER, GLFW_KEY_ESCAPE,
    GLFW_KEY_SPACE, GLFW_KEY_F1,     GLFW_KEY_A,      GLFW_KEY_C,         GLFW_KEY_H,     GLFW_KEY_P,
    GLFW_KEY_R,     GLFW_KEY_V,      GLFW_KEY_X,      GLFW_KEY_Y,         GLFW_KEY_Z};
constexpr std::array<int, kMouseButtonCount> kGlfwButtons{GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT,
                                                          GLFW_MOUSE_BUTTON_MIDDLE};

std::string lastError() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

/// GLFW counts as one library for the whole process: the last window ends it.
class Library {
 public:
  Library() {
    if (!glfwInit()) {
      throw MissingError("no display to open a window on (" + lastError() +
                         "); migiwa render draws without one, and so does xvfb-run migiwa view"
                         " (on Debian: apt-get install xvfb xauth)");
    }
  }
  ~Library() { glfwTerminate(); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

}  // namespace

struct GlfwWindow::State {
  Library library;
  GLFWwindow* window = nullptr;
  InputState input;
  /// Pressed since the last call, so that a click shorter than a frame is not lost.
  std::array<bool, kMouseButtonCount> clicked{};
  std::array<bool, kKeyCount> typed{};
  bool happened = true;
  double time = 0;

  State() = default;
  ~State() {
    if (window) glfwDestroyWindow(window);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  static State& of(GLFWwindow* window) { return *static_cast<State*>(glfwGetWindowUserPointer(window)); }
  void listen();
};

void GlfwWindow::State::listen() {
  glfwSetWindowUserPointer(window, this);
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    const auto place = std::find(kGlfwButtons.begin(), kGlfwButtons.end(), button);
    if (place == kGlfwButtons.end()) return;
    const auto i = static_cast<std::size_t>(place - kGlfwButtons.begin());
    of(w).input.buttons[i] = action == GLFW_PRESS;
    if (action == GLFW_PRESS) of(w).clicked[i] = true;
    of(w).happened = true;
  });
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
    State& state = of(w);
    state.happened = true;
    const auto place = std::find(kGlfwKeys.begin(), kGlfwKeys.end(), key);
    if (place == kGlfwKeys.end()) return;
    const auto i = static_cast<std::size_t>(place - kGlfwKeys.begin());
    state.input.keys[i] = action != GLFW_RELEASE;
    if (action == GLFW_PRESS) state.typed[i] = true;
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned character) {
    of(w).input.characters.push_back(character);
    of(w).happened = true;
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    of(w).input.dropped.insert(of(w).input.dropped.end(), paths, paths + count);
    of(w).happened = true;
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) {
    of(w).input.wheel += static_cast<float>(y);
    of(w).happened = true;
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double, double) { of(w).happened = true; });
  glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int) { of(w).happened = true; });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).happened = true; });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).happened = true; });
}

GlfwWindow::GlfwWindow(const std::string& title, int width, int height) : state_(std::make_unique<State>()) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  // Everything is drawn into a framebuffer of our own: the window's needs neither depth nor samples.
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  state_->window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!state_->window) {
    throw MissingError("no window with OpenGL 4.5 can be opened here (" + lastError() +
                       "); on Debian: apt-get install libgl1-mesa-dri");
  }
  state_->listen();
  glfwMakeContextCurrent(state_->window);
  loadGl(&glfwGetProcAddress);
  glfwSwapInterval(1);
}

GlfwWindow::~GlfwWindow() = default;

std::string GlfwWindow::renderer() const {
  return describeGl();
}

bool GlfwWindow::shouldClose() const {
  return glfwWindowShouldClose(state_->window) == GLFW_TRUE;
}

void GlfwWindow::setTitle(const std::string& title) {
  glfwSetWindowTitle(state_->window, title.c_str());
}

InputState GlfwWindow::waitForInput(double seconds) {
  State& state = *state_;
  state.happened = false;
  if (seconds > 0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
  const double now = glfwGetTime();
  InputState input = state.input;
  input.seconds = std::max(1e-4, now - std::exchange(state.time, now));
  for (std::size_t i = 0; i < kMouseButtonCount; ++i) {
    if (std::exchange(state.clicked[i], false)) input.buttons[i] = true;
  }
  for (std::size_t i = 0; i < kKeyCount; ++i) {
    if (std::exchange(state.typed[i], false)) input.keys[i] = true;
  }
  const auto held = [&](int left, int right) {
    return glfwGetKey(state.window, left) == GLFW_PRESS || glfwGetKey(state.window, right) == GLFW_PRESS;
  };
  input.control = held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  input.shift = held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  input.alt = held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
  state.input.wheel = 0;
  state.input.characters.clear();
  state.input.dropped.clear();

  double x = 0, y = 0;
  int width = 1, height = 1;
  glfwGetCursorPos(state.window, &x, &y);
  glfwGetWindowSize(state.window, &width, &height);
  const std::array<int, 2> pixels = framebufferSize();
  input.mouseX = static_cast<float>(x * pixels[0] / std::max(width, 1));
  input.mouseY = static_cast<float>(y * pixels[1] / std::max(height, 1));
  input.mouseInside = glfwGetWindowAttrib(state.window, GLFW_HOVERED) == GLFW_TRUE || input.buttons[0] ||
                      input.buttons[1] || input.buttons[2];
  return input;
}

bool GlfwWindow::somethingHappened() const {
  return state_->happened;
}

std::array<int, 2> GlfwWindow::framebufferSize() const {
  std::array<int, 2> size{};
  glfwGetFramebufferSize(state_->window, &size[0], &size[1]);
  return size;
}

double GlfwWindow::contentScale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(state_->window, &x, &y);
  return std::max(1.0, static_cast<double>(std::max(x, y)));
}

void GlfwWindow::finish() {
  glFinish();
}

void GlfwWindow::swap() {
  glfwSwapBuffers(state_->window);
}

Clipboard GlfwWindow::clipboard() const {
  GLFWwindow* const window = state_->window;
  return {[window](const std::string& text) { glfwSetClipboardString(window, text.c_str()); },
          [window] {
            const char* const text = glfwGetClipboardString(window);
            return std::string(text != nullptr ? text : "");
          }};
}

}  // namespace migiwa
