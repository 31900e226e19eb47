// EGL is included here and nowhere else.
#include "app/platform/context.h"
#include "core/base/messages.h"

#define EGL_NO_X11
#include <array>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "app/platform/context.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

class EglContext final : public GlContext {
 public:
  EglContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  ~EglContext() override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  std::string renderer() const override { return describeGl(); }

 private:
  // The display is left to the process: EGL shares it between contexts, and terminating it would end them
  // all.
  EGLDisplay display_;
  EGLContext context_;
};

template <class Function>
Function eglFunction(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

bool hasExtension(std::string_view name) {
  const char* list = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  return list && std::string_view(list).find(name) != std::string_view::npos;
}

/// Displays that need no window system, best first: an NVIDIA driver answers to its device only, Mesa to
/// both.
std::vector<EGLDisplay> candidateDisplays() {
  std::vector<EGLDisplay> displays;
  const auto platformDisplay = eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (!platformDisplay) return displays;
  const auto queryDevices = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  if (queryDevices && hasExtension("EGL_EXT_platform_device")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (!queryDevices(static_cast<EGLint>(devices.size()), devices.data(), &count)) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      displays.push_back(
          platformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
    }
  }
  if (hasExtension("EGL_MESA_platform_surfaceless")) {
    displays.push_back(platformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr));
  }
  return displays;
}

EGLContext tryContext(EGLDisplay display) {
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_CONTEXT;
  if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                         4,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         5,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_NONE};
  EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) return context;
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return context;
  eglDestroyContext(display, context);
  return EGL_NO_CONTEXT;
}

}  // namespace

std::unique_ptr<GlContext> makeEglContext() {
  for (EGLDisplay display : candidateDisplays()) {
    EGLContext context = tryContext(display);
    if (context == EGL_NO_CONTEXT) continue;
    auto result = std::make_unique<EglContext>(display, context);
    loadGl(&eglGetProcAddress);
    return result;
  }
  throw MissingError(
      "no EGL device here can draw OpenGL 4.5 without a display; "
      "on Debian: apt-get install libegl1 libgl1-mesa-dri");
}

void loadGl(GlProcLoader loader) {
  const int version = gladLoadGL(loader);
  if (version < GLAD_MAKE_VERSION(4, 5)) {
    throw MissingError("OpenGL 4.5 is needed, and this machine's driver offers " +
                       std::to_string(GLAD_VERSION_MAJOR(version)) + "." +
                       std::to_string(GLAD_VERSION_MINOR(version)) +
                       "; on Debian: apt-get install libgl1-mesa-dri");
  }
}

std::string describeGl() {
  const auto text = [](GLenum name) { return std::string(reinterpret_cast<const char*>(glGetString(name))); };
  return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

}  // namespace migiwa
