#include "app/render/surface_pass.h"

#include <vector>

namespace migiwa {
namespace {

struct Vertex {
  Vec3f position, normal;
};
static_assert(sizeof(Vertex) == 6 * sizeof(float), "no padding");

}  // namespace

SurfacePass::SurfacePass()
    : program_("surface"), vertices_(makeBuffer()), indices_(makeBuffer()), layout_(makeVertexArray()) {
  glVertexArrayVertexBuffer(layout_.name(), 0, vertices_.name(), 0, sizeof(Vertex));
  glVertexArrayElementBuffer(layout_.name(), indices_.name());
  for (const GLuint attribute : {0U, 1U}) {
    glEnableVertexArrayAttrib(layout_.name(), attribute);
    glVertexArrayAttribFormat(layout_.name(), attribute, 3, GL_FLOAT, GL_FALSE,
                              static_cast<GLuint>(sizeof(Vec3f)) * attribute);
    glVertexArrayAttribBinding(layout_.name(), attribute, 0);
  }
}

void SurfacePass::set(std::span<const WallMesh> meshes) {
  std::vector<Vertex> vertices;
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
  glNamedBufferData(vertices_.name(), static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)),
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
  glDrawElements(GL_TRIANGLES, vesselIndices_, GL_UNSIGNED_INT, reinterpret_cast<const void*>(offset));
  glDisable(GL_CULL_FACE);
}

}  // namespace migiwa
