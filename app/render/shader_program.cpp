#include "app/render/shader_program.h"

#include <stdexcept>
#include <string>

#include "app/render/shader_source.h"

namespace migiwa {
namespace {

struct ShaderKind {
  static void destroy(GLuint name) { glDeleteShader(name); }
};
using Shader = GlObject<ShaderKind>;

Shader compile(GLenum stage, const std::string& name) {
  Shader shader(glCreateShader(stage));
  const std::string source = shaderSource(name);
  const char* text = source.c_str();
  glShaderSource(shader.name(), 1, &text, nullptr);
  glCompileShader(shader.name());
  GLint done = 0;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &done);
  if (!done) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader.name(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw std::runtime_error("shader " + name + " does not compile:\n" + log);
  }
  return shader;
}

}  // namespace

ShaderProgram::ShaderProgram(std::string_view name) : program_(glCreateProgram()) {
  const Shader vertex = compile(GL_VERTEX_SHADER, std::string(name) + ".vert");
  const Shader fragment = compile(GL_FRAGMENT_SHADER, std::string(name) + ".frag");
  glAttachShader(program_.name(), vertex.name());
  glAttachShader(program_.name(), fragment.name());
  glLinkProgram(program_.name());
  GLint done = 0;
  glGetProgramiv(program_.name(), GL_LINK_STATUS, &done);
  if (!done) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetProgramInfoLog(program_.name(), static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw std::runtime_error("shader program " + std::string(name) + " does not link:\n" + log);
  }
}

}  // namespace migiwa
