// What lies behind and under the scene, so that depth can be read: a gradient, a grid on the ground, a soft
// shadow.
#pragma once

#include <span>

#include "app/render/ground_shadow.h"
#include "app/render/shader_program.h"

namespace migiwa {

class GroundPass {
 public:
  explicit GroundPass(const Ground& ground);
  /// `spheres` and `patches` throw the shadow (GroundShadow); the ground is not drawn from below.
  void draw(std::span<const Float4> spheres, float radius, std::span<const Float4> patches, const Vec3d& eye);

 private:
  Ground ground_;
  GroundShadow shadow_;
  ShaderProgram background_, plane_;
  GlTexture shadowMap_;
  GlVertexArray layout_;
};

}  // namespace migiwa
