// The text of a shader: built into the program, or read from the folder that the environment variable
// MIGIWA_SHADERS names, so that a shader can be edited without building. `#include "FILE"` on a line of its
// own is resolved here.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace migiwa {

struct EmbeddedShader {
  std::string_view name;
  std::string_view text;
};

/// Every file of shaders/, generated at build time.
std::span<const EmbeddedShader> embeddedShaders();

/// The text of shaders/`name` with its includes. Throws InputError when the override folder lacks it.
std::string shaderSource(std::string_view name);

}  // namespace migiwa
