// OpenGL 4.5 core, loaded once a context is current. Only app/render and app/platform include this.
#pragma once

#include <string>

#include <glad/gl.h>

namespace migiwa {

using GlProc = void (*)();
using GlProcLoader = GlProc (*)(const char* name);

/// Loads the functions of the current context; throws MissingError when it is older than OpenGL 4.5.
void loadGl(GlProcLoader loader);

/// Driver and version of the current context.
std::string describeGl();

}  // namespace migiwa
