// Lines of walls, anti-aliased, a fixed number of pixels wide.
#pragma once

#include <span>

#include "app/render/shader_program.h"
#include "core/boundary/wall_drawing.h"

namespace migiwa {

class LinePass {
 public:
  LinePass();
  /// From now on draws these.
  void set(std::span<const LineSegment> lines);
  /// Where an opaque line is made of short segments, these do not show.
  void draw(float widthPixels, float alpha) const;

 private:
  ShaderProgram program_;
  GlBuffer lines_;
  GlVertexArray layout_;
  GLsizei count_ = 0;
};

}  // namespace migiwa
