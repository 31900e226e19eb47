// A linked pair of shaders.
#pragma once

#include <string_view>

#include "app/render/gl_objects.h"

namespace migiwa {

struct ProgramKind {
  static void destroy(GLuint name) { glDeleteProgram(name); }
};

class ShaderProgram {
 public:
  /// Compiles shaders/`name`.vert and shaders/`name`.frag. Throws std::runtime_error with the driver's log.
  explicit ShaderProgram(std::string_view name);

  void use() const { glUseProgram(program_.name()); }
  GLint uniform(const char* name) const { return glGetUniformLocation(program_.name(), name); }
  void set(const char* name, int value) const { glProgramUniform1i(program_.name(), uniform(name), value); }
  void set(const char* name, float value) const { glProgramUniform1f(program_.name(), uniform(name), value); }
  void set(const char* name, float x, float y) const {
    glProgramUniform2f(program_.name(), uniform(name), x, y);
  }
  void set(const char* name, float x, float y, float z, float w) const {
    glProgramUniform4f(program_.name(), uniform(name), x, y, z, w);
  }

 private:
  GlObject<ProgramKind> program_;
};

}  // namespace migiwa
