// Particles as lit spheres: one camera-facing quad each, the sphere found by ray in the fragment shader.
#pragma once

#include <span>

#include "app/render/color_map.h"
#include "app/render/shader_program.h"
#include "core/base/types.h"

namespace migiwa {

class SpherePass {
 public:
  explicit SpherePass(const ColorMap& colors);

  /// `spheres`: centre (m) and, in w, the colour value in [0, 1].
  void draw(std::span<const Float4> spheres, float radius);

 private:
  ShaderProgram program_;
  GlTexture colors_;
  GlBuffer spheres_;
  GlVertexArray layout_;
  std::size_t capacity_ = 0;
};

}  // namespace migiwa
