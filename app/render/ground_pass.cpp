#include "app/render/ground_pass.h"

#include <cmath>

namespace migiwa {

GroundPass::GroundPass(const Ground& ground)
    : ground_(ground),
      shadow_(ground),
      background_("background"),
      plane_("ground"),
      shadowMap_(makeTexture(GL_TEXTURE_2D)),
      layout_(makeVertexArray()) {
  glTextureStorage2D(shadowMap_.name(), 1, GL_R32F, GroundShadow::kSize, GroundShadow::kSize);
  glTextureParameteri(shadowMap_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(shadowMap_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTextureParameteri(shadowMap_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);

  const auto f = [](double v) { return static_cast<float>(v); };
  plane_.set("origin", f(ground_.center.x()), f(ground_.center.y()), f(ground_.center.z()),
             f(ground_.halfSide));
  plane_.set("axisU", f(ground_.u.x()), f(ground_.u.y()), f(ground_.u.z()), 0);
  plane_.set("axisV", f(ground_.v.x()), f(ground_.v.y()), f(ground_.v.z()), 0);
  const double period = 5 * ground_.gridSpacing;
  plane_.set("gridOffset", f(std::fmod(ground_.center.dot(ground_.u), period)),
             f(std::fmod(ground_.center.dot(ground_.v), period)), f(ground_.gridSpacing), 0);
  const double half = shadow_.halfSide();
  plane_.set("shadowArea", f(-half), f(-half), f(2 * half), f(2 * half));
}

void GroundPass::draw(std::span<const Float4> spheres, float radius, std::span<const Float4> patches,
                      const Vec3d& eye) {
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDisable(GL_BLEND);
  glBindVertexArray(layout_.name());
  background_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  if (ground_.heightOf(eye) <= 0) return;

  const std::span<const float> shadow = shadow_.compute(spheres, radius, patches);
  glTextureSubImage2D(shadowMap_.name(), 0, 0, 0, GroundShadow::kSize, GroundShadow::kSize, GL_RED, GL_FLOAT,
                      shadow.data());
  glBindTextureUnit(1, shadowMap_.name());
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  plane_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace migiwa
