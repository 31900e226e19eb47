#include "app/render/passes.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "app/render/image.h"

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

void SpherePass::setColors(const ColorMap& colors) {
  colors_ = makeColorTexture(colors);
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

void LinePass::draw(float widthPixels, const std::array<float, 4>& color) const {
  if (count_ == 0) return;
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  program_.set("width", widthPixels);
  program_.set("lineColor", color[0], color[1], color[2], color[3]);
  program_.use();
  glBindVertexArray(layout_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_);
}

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

void describeMesh(const GlVertexArray& layout, const GlBuffer& vertices, const GlBuffer& indices) {
  glVertexArrayVertexBuffer(layout.name(), 0, vertices.name(), 0, sizeof(MeshVertex));
  glVertexArrayElementBuffer(layout.name(), indices.name());
  for (const GLuint attribute : {0U, 1U}) {
    glEnableVertexArrayAttrib(layout.name(), attribute);
    glVertexArrayAttribFormat(layout.name(), attribute, 3, GL_FLOAT, GL_FALSE,
                              static_cast<GLuint>(sizeof(Vec3f)) * attribute);
    glVertexArrayAttribBinding(layout.name(), attribute, 0);
  }
}

SurfacePass::SurfacePass()
    : program_("surface"), vertices_(makeBuffer()), indices_(makeBuffer()), layout_(makeVertexArray()) {
  describeMesh(layout_, vertices_, indices_);
}

void SurfacePass::set(std::span<const WallMesh> meshes) {
  std::vector<MeshVertex> vertices;
  std::vector<GLuint> indices;
  for (const bool vessels : {false, true}) {
    for (const WallMesh& mesh : meshes) {
      if (mesh.vessel != vessels) continue;
      const auto first = static_cast<GLuint>(vertices.size());
      for (std::size_t k = 0; k < mesh.surface.vertices.size(); ++k)
        vertices.push_back({mesh.surface.vertices[k], mesh.normals[k]});
      for (const auto& corners : mesh.surface.triangles)
        for (const std::uint32_t corner : corners) indices.push_back(first + corner);
    }
    (vessels ? vesselIndices_ : solidIndices_) =
        static_cast<GLsizei>(indices.size()) - (vessels ? solidIndices_ : 0);
  }
  glNamedBufferData(vertices_.name(), static_cast<GLsizeiptr>(vertices.size() * sizeof(MeshVertex)),
                    vertices.data(), GL_DYNAMIC_DRAW);
  glNamedBufferData(indices_.name(), static_cast<GLsizeiptr>(indices.size() * sizeof(GLuint)), indices.data(),
                    GL_DYNAMIC_DRAW);
}

void SurfacePass::drawOpaque() const {
  if (solidIndices_ + vesselIndices_ == 0) return;
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CLIP_DISTANCE0);
  program_.set("glass", 0);
  program_.use();
  glBindVertexArray(layout_.name());
  glDrawElements(GL_TRIANGLES, solidIndices_, GL_UNSIGNED_INT, nullptr);
  drawVessels(GL_BACK);
  glDisable(GL_CLIP_DISTANCE0);
}

void SurfacePass::drawGlass() const {
  if (vesselIndices_ == 0) return;
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glEnable(GL_CLIP_DISTANCE0);
  program_.set("glass", 1);
  program_.use();
  glBindVertexArray(layout_.name());
  // Depth first, so that only the layer nearest to the eye is blended, whatever the order of the triangles.
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  drawVessels(GL_FRONT);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  drawVessels(GL_FRONT);
  glDepthFunc(GL_LESS);
  glDisable(GL_CLIP_DISTANCE0);
}

void SurfacePass::drawVessels(GLenum culled) const {
  glEnable(GL_CULL_FACE);
  glCullFace(culled);
  const std::size_t offset = static_cast<std::size_t>(solidIndices_) * sizeof(GLuint);
  glDrawElements(GL_TRIANGLES, vesselIndices_, GL_UNSIGNED_INT, std::bit_cast<const void*>(offset));
  glDisable(GL_CULL_FACE);
}

SheetPass::SheetPass() : program_("section"), layout_(makeVertexArray()) {}

void SheetPass::set(const Sheet& sheet) {
  picture_ = makePictureTexture(sheet.picture);
  const auto put = [&](const char* name, const Vec3d& v) {
    program_.set(name, static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0);
  };
  put("corner", sheet.corner);
  put("across", sheet.across);
  put("side", sheet.up);
}

void SheetPass::draw() const {
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  program_.use();
  glBindTextureUnit(0, picture_.name());
  glBindVertexArray(layout_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace migiwa
