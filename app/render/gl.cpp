#include "app/render/gl.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/base/messages.h"

namespace migiwa {
namespace {

template <class Object, class Create>
Object make(const Create& create) {
  GLuint name = 0;
  create(&name);
  return Object(name);
}

}  // namespace

GlBuffer makeBuffer() {
  return make<GlBuffer>([](GLuint* name) { glCreateBuffers(1, name); });
}
GlVertexArray makeVertexArray() {
  return make<GlVertexArray>([](GLuint* name) { glCreateVertexArrays(1, name); });
}
GlTexture makeTexture(GLenum target) {
  return make<GlTexture>([target](GLuint* name) { glCreateTextures(target, 1, name); });
}
GlRenderbuffer makeRenderbuffer() {
  return make<GlRenderbuffer>([](GLuint* name) { glCreateRenderbuffers(1, name); });
}
GlFramebuffer makeFramebuffer() {
  return make<GlFramebuffer>([](GLuint* name) { glCreateFramebuffers(1, name); });
}

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

ShaderProgram::ShaderProgram(std::string_view name, std::string_view vertexName)
    : program_(glCreateProgram()) {
  const Shader vertex =
      compile(GL_VERTEX_SHADER, std::string(vertexName.empty() ? name : vertexName) + ".vert");
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

namespace {

std::string fileText(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw InputError("MIGIWA_SHADERS",
                     "expected a folder that holds every shader, found no " + file.string());
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string text(std::string_view name) {
  if (const char* folder = std::getenv("MIGIWA_SHADERS"))
    return fileText(std::filesystem::path(folder) / name);
  for (const EmbeddedShader& shader : embeddedShaders())
    if (shader.name == name) return std::string(shader.text);
  throw std::logic_error("no shader is called " + std::string(name));
}

}  // namespace

std::string shaderSource(std::string_view name) {
  static constexpr std::string_view kInclude = "#include \"";
  std::istringstream in(text(name));
  std::string result, line;
  while (std::getline(in, line)) {
    if (line.starts_with(kInclude)) {
      const std::size_t end = line.find('"', kInclude.size());
      result += shaderSource(line.substr(kInclude.size(), end - kInclude.size()));
    } else {
      result += line + '\n';
    }
  }
  return result;
}

}  // namespace migiwa
