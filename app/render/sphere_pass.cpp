#include "app/render/sphere_pass.h"

#include "app/render/color_texture.h"

namespace migiwa {

SpherePass::SpherePass(const ColorMap& colors)
    : program_("sphere"),
      colors_(makeColorTexture(colors)),
      spheres_(makeBuffer()),
      layout_(makeVertexArray()) {
  glVertexArrayVertexBuffer(layout_.name(), 0, spheres_.name(), 0, sizeof(Float4));
  glVertexArrayBindingDivisor(layout_.name(), 0, 1);
  glEnableVertexArrayAttrib(layout_.name(), 0);
  glVertexArrayAttribFormat(layout_.name(), 0, 4, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(layout_.name(), 0, 0);
}

void SpherePass::draw(std::span<const Float4> spheres, float radius) {
  if (spheres.empty()) return;
  if (spheres.size() > capacity_) {
    capacity_ = spheres.size() + spheres.size() / 2;
    glNamedBufferData(spheres_.name(), static_cast<GLsizeiptr>(capacity_ * sizeof(Float4)), nullptr,
                      GL_STREAM_DRAW);
  }
  glNamedBufferSubData(spheres_.name(), 0, static_cast<GLsizeiptr>(spheres.size_bytes()), spheres.data());

  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  program_.set("radius", radius);
  program_.use();
  glBindTextureUnit(0, colors_.name());
  glBindVertexArray(layout_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(spheres.size()));
}

}  // namespace migiwa
