#include "app/render/shader_source.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/error.h"

namespace migiwa {
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
