// An off-screen context through EGL: no display, no window, no surface.
#pragma once

#include <memory>

#include "app/platform/gl_context.h"

namespace migiwa {

/// Makes a context and makes it current. Throws MissingError with what to install when this machine has none.
std::unique_ptr<GlContext> makeEglContext();

}  // namespace migiwa
