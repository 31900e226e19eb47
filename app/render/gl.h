// OpenGL objects, and programs of shaders.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "app/platform/context.h"

namespace migiwa {

// OpenGL names that are freed with their owner. The context that made them must be current when they go.

template <class Kind>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint name) : name_(name) {}
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlObject() {
    if (name_ != 0) Kind::destroy(name_);
  }
  GLuint name() const { return name_; }

 private:
  GLuint name_ = 0;
};

struct BufferKind {
  static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct VertexArrayKind {
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct TextureKind {
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct RenderbufferKind {
  static void destroy(GLuint name) { glDeleteRenderbuffers(1, &name); }
};
struct FramebufferKind {
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};

using GlBuffer = GlObject<BufferKind>;
using GlVertexArray = GlObject<VertexArrayKind>;
using GlTexture = GlObject<TextureKind>;
using GlRenderbuffer = GlObject<RenderbufferKind>;
using GlFramebuffer = GlObject<FramebufferKind>;

GlBuffer makeBuffer();
GlVertexArray makeVertexArray();
GlTexture makeTexture(GLenum target);
GlRenderbuffer makeRenderbuffer();
GlFramebuffer makeFramebuffer();

// A linked pair of shaders.

struct ProgramKind {
  static void destroy(GLuint name) { glDeleteProgram(name); }
};

class ShaderProgram {
 public:
  /// Compiles shaders/`name`.vert and shaders/`name`.frag, or another program's .vert. Throws
  /// std::runtime_error with the driver's log.
  explicit ShaderProgram(std::string_view name, std::string_view vertexName = {});

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

// The text of a shader: built into the program, or read from the folder that the environment variable
// MIGIWA_SHADERS names, so that a shader can be edited without building. `#include "FILE"` on a line of its
// own is resolved here.

struct EmbeddedShader {
  std::string_view name;
  std::string_view text;
};

/// Every file of shaders/, generated at build time.
std::span<const EmbeddedShader> embeddedShaders();

/// The text of shaders/`name` with its includes. Throws InputError when the override folder lacks it.
std::string shaderSource(std::string_view name);

}  // namespace migiwa
