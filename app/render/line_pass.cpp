#include "app/render/line_pass.h"

namespace migiwa {

LinePass::LinePass() : program_("line"), lines_(makeBuffer()), layout_(makeVertexArray()) {
  static_assert(sizeof(LineSegment) == 6 * sizeof(float), "two points without padding");
  glVertexArrayVertexBuffer(layout_.name(), 0, lines_.name(), 0, sizeof(LineSegment));
  glVertexArrayBindingDivisor(layout_.name(), 0, 1);
  for (const GLuint end : {0U, 1U}) {
    glEnableVertexArrayAttrib(layout_.name(), end);
    glVertexArrayAttribFormat(layout_.name(), end, 3, GL_FLOAT, GL_FALSE,
                              static_cast<GLuint>(sizeof(Vec3f)) * end);
    glVertexArrayAttribBinding(layout_.name(), end, 0);
  }
}

void LinePass::set(std::span<const LineSegment> lines) {
  count_ = static_cast<GLsizei>(lines.size());
  glNamedBufferData(lines_.name(), static_cast<GLsizeiptr>(lines.size_bytes()), lines.data(),
                    GL_DYNAMIC_DRAW);
}

void LinePass::draw(float widthPixels, float alpha) const {
  if (count_ == 0) return;
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  program_.set("width", widthPixels);
  program_.set("lineColor", 0.16F, 0.22F, 0.30F, alpha);
  program_.use();
  glBindVertexArray(layout_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_);
}

}  // namespace migiwa
