#include "app/render/node_pass.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "app/render/color_texture.h"

namespace migiwa {
namespace {

struct Disc {
  Float4 place;   ///< centre and radius (m)
  Float4 normal;  ///< and the colour value
  float vessel;
};
static_assert(offsetof(Disc, vessel) == 8 * sizeof(float));

/// The sizes between the smallest and the largest hundredth; a few large balls would leave little of the
/// colours to the others.
std::array<double, 2> rangeOf(std::span<const WallNode> nodes) {
  std::vector<float> radii;
  for (const WallNode& node : nodes) radii.push_back(node.ballRadius);
  std::sort(radii.begin(), radii.end());
  const std::size_t hundredth = radii.size() / 100;
  const auto low = static_cast<double>(radii[hundredth]),
             high = static_cast<double>(radii[radii.size() - 1 - hundredth]);
  // Balls of one size are in the middle of the colours.
  if (high < 1.001 * low) return {0, 2 * high};
  return {low, high};
}

}  // namespace

NodePass::NodePass()
    : program_("node"),
      colors_(makeColorTexture(makeWarmColorMap())),
      discs_(makeBuffer()),
      layout_(makeVertexArray()) {
  glVertexArrayVertexBuffer(layout_.name(), 0, discs_.name(), 0, sizeof(Disc));
  glVertexArrayBindingDivisor(layout_.name(), 0, 1);
  for (const GLuint attribute : {0U, 1U, 2U}) {
    glEnableVertexArrayAttrib(layout_.name(), attribute);
    glVertexArrayAttribFormat(layout_.name(), attribute, attribute < 2 ? 4 : 1, GL_FLOAT, GL_FALSE,
                              static_cast<GLuint>(sizeof(Float4)) * attribute);
    glVertexArrayAttribBinding(layout_.name(), attribute, 0);
  }
}

void NodePass::set(std::span<const WallNode> nodes) {
  count_ = static_cast<GLsizei>(nodes.size());
  if (nodes.empty()) return;
  range_ = rangeOf(nodes);
  std::vector<Disc> discs;
  for (const WallNode& node : nodes) {
    const double value =
        std::clamp((static_cast<double>(node.ballRadius) - range_[0]) / (range_[1] - range_[0]), 0.0, 1.0);
    discs.push_back({Float4(node.centre, node.discRadius), Float4(node.normal, static_cast<float>(value)),
                     node.vessel ? 1.0F : 0.0F});
  }
  glNamedBufferData(discs_.name(), static_cast<GLsizeiptr>(discs.size() * sizeof(Disc)), discs.data(),
                    GL_DYNAMIC_DRAW);
}

void NodePass::draw() const {
  if (empty()) return;
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CLIP_DISTANCE0);
  program_.use();
  glBindTextureUnit(0, colors_.name());
  glBindVertexArray(layout_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_);
  glDisable(GL_CLIP_DISTANCE0);
}

}  // namespace migiwa
