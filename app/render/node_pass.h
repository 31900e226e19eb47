// The nodes of SLIM walls as discs, coloured by the radius of their balls and cut by the clip plane. On the
// near side of a vessel only their rims are drawn.
#pragma once

#include <array>
#include <span>

#include "app/render/color_map.h"
#include "app/render/shader_program.h"
#include "core/boundary/wall_drawing.h"
#include "core/simulation/frame_view.h"

namespace migiwa {

class NodePass {
 public:
  NodePass();
  /// From now on draws these.
  void set(std::span<const WallNode> nodes);

  bool empty() const { return count_ == 0; }
  /// What their colours mean.
  static ColorFieldInfo legend() { return {"radius of the balls", "m"}; }
  /// Radii (m) at the ends of the colour map: those of all but a few balls.
  const std::array<double, 2>& range() const { return range_; }
  void draw() const;

 private:
  ShaderProgram program_;
  GlTexture colors_;
  GlBuffer discs_;
  GlVertexArray layout_;
  GLsizei count_ = 0;
  std::array<double, 2> range_{0, 1};
};

}  // namespace migiwa
