#include "app/platform/gl_api.h"

#include "core/base/error.h"

namespace migiwa {

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
