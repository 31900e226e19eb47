// An OpenGL 4.5 core context, off-screen or a window's: all that drawing needs to know of either.
#pragma once

#include <string>

namespace migiwa {

class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Driver and version, such as "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
  virtual std::string renderer() const = 0;
};

}  // namespace migiwa
