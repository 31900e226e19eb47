// The walls' lines, anti-aliased, a fixed number of pixels wide.
#pragma once

#include <span>

#include "app/render/shader_program.h"
#include "core/boundary/surface.h"

namespace migiwa {

class LinePass {
 public:
  LinePass();
  /// From now on draws these.
  void set(std::span<const LineSegment> lines);
  void draw(float widthPixels) const;

 private:
  ShaderProgram program_;
  GlBuffer lines_;
  GlVertexArray layout_;
  GLsizei count_ = 0;
};

}  // namespace migiwa
