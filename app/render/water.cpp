#include <array>
#include <bit>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>

#include "app/render/image.h"
#include "app/render/passes.h"

namespace migiwa {
namespace {

/// Faces to walls that turn by less than this are parts of one smooth wall (cosine).
constexpr float kSmooth = 0.8F, kSame = 0.9999F;

constexpr std::array<float, 4> kNothing{0, 0, 0, 0};
constexpr float kFarthestDepth = 1;  // depth

/// Of the picture behind the water: where refraction shows much of it on few pixels, its mean is seen.
constexpr GLsizei kLevels = 5;

/// Faces to walls with vertices of their own, whose normals are means over the faces around them that are of
/// the same side of the wall: the mesh's own normals belong to the free surface where that ends at a wall.
struct WetFaces {
  std::vector<MeshVertex> vertices;
  std::vector<GLuint> corners;
};
WetFaces wetFaces(const SurfaceMesh& mesh) {
  std::vector<Vec3f> faces;  // their normals, times twice the area
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    if (mesh.wet[k] == 0) continue;
    const auto& [a, b, c] = mesh.triangles[k];
    triangles.push_back(mesh.triangles[k]);
    faces.emplace_back((mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]));
  }
  // The faces around each vertex: as a list of lists in one array.
  std::vector<std::uint32_t> begin(mesh.positions.size() + 1, 0);
  for (const auto& corners : triangles)
    for (const std::uint32_t corner : corners) ++begin[corner + 1];
  for (std::size_t k = 1; k < begin.size(); ++k) begin[k] += begin[k - 1];
  std::vector<std::uint32_t> around(begin.back()), next(begin.begin(), begin.end() - 1);
  for (std::size_t k = 0; k < triangles.size(); ++k)
    for (const std::uint32_t corner : triangles[k]) around[next[corner]++] = static_cast<std::uint32_t>(k);

  WetFaces result;
  std::vector<GLuint> made(around.size());  // of each face around a vertex
  std::vector<std::uint32_t> done(begin.begin(), begin.end() - 1);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const float size = faces[k].norm();
    for (const std::uint32_t corner : triangles[k]) {
      Vec3f sum = Vec3f::Zero();
      for (std::uint32_t i = begin[corner]; i < begin[corner + 1]; ++i) {
        const Vec3f& other = faces[around[i]];
        if (other.dot(faces[k]) >= kSmooth * other.norm() * size) sum += other;
      }
      const Vec3f normal = sum.norm() > 0 ? Vec3f(sum.normalized()) : sum;
      // The same normal has been made for another face around the vertex, mostly.
      std::uint32_t i = begin[corner];
      while (i < done[corner] && result.vertices[made[i]].normal.dot(normal) < kSame) ++i;
      if (i == done[corner]) {
        made[done[corner]++] = static_cast<GLuint>(result.vertices.size());
        result.vertices.push_back({mesh.positions[corner], normal});
      }
      result.corners.push_back(made[i]);
    }
  }
  return result;
}

GlTexture makeLayer(GLenum format, int width, int height, GLsizei levels = 1) {
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), levels, format, width, height);
  for (const GLenum direction : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}})
    glTextureParameteri(texture.name(), direction, GL_CLAMP_TO_EDGE);
  const GLint filter = format == GL_RGBA8 ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : filter);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, filter);
  return texture;
}

void requireComplete(const GlFramebuffer& framebuffer) {
  if (glCheckNamedFramebufferStatus(framebuffer.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("the driver refuses a framebuffer of the water's layers");
}

}  // namespace

WaterPass::WaterPass()
    : layer_("water_layer"),
      surface_("water"),
      cover_("water_cover", "water"),
      vertices_(makeBuffer()),
      indices_(makeBuffer()),
      layout_(makeVertexArray()) {
  describeMesh(layout_, vertices_, indices_);
}

void WaterPass::set(const SurfaceMesh& mesh) {
  bounds_ = {};
  for (const Vec3f& p : mesh.positions) bounds_.include(p.cast<double>());
  std::vector<MeshVertex> vertices;
  std::vector<GLuint> indices;
  for (std::size_t k = 0; k < mesh.positions.size(); ++k)
    vertices.push_back({mesh.positions[k], mesh.normals[k]});
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    if (mesh.wet[k] == 0) indices.insert(indices.end(), mesh.triangles[k].begin(), mesh.triangles[k].end());
  freeIndices_ = static_cast<GLsizei>(indices.size());
  const WetFaces wet = wetFaces(mesh);
  for (const GLuint corner : wet.corners) indices.push_back(static_cast<GLuint>(vertices.size()) + corner);
  vertices.insert(vertices.end(), wet.vertices.begin(), wet.vertices.end());
  wetIndices_ = static_cast<GLsizei>(indices.size()) - freeIndices_;
  glNamedBufferData(vertices_.name(), static_cast<GLsizeiptr>(vertices.size() * sizeof(MeshVertex)),
                    vertices.data(), GL_STREAM_DRAW);
  glNamedBufferData(indices_.name(), static_cast<GLsizeiptr>(indices.size() * sizeof(GLuint)), indices.data(),
                    GL_STREAM_DRAW);
}

void WaterPass::resize(const RenderTarget& target) {
  if (width_ == target.width() && height_ == target.height()) return;
  width_ = target.width(), height_ = target.height();
  opaque_ = makeLayer(GL_RGBA8, width_, height_);
  all_ = makeLayer(GL_RGBA8, width_, height_, kLevels);
  colors_ = makeLayer(GL_RGBA8, width_, height_);
  depth_ = makeLayer(GL_DEPTH_COMPONENT32F, width_, height_);
  for (GlRenderbuffer* depth : {&entriesDepth_, &exitsDepth_, &farEntriesDepth_}) {
    *depth = makeRenderbuffer();
    glNamedRenderbufferStorage(depth->name(), GL_DEPTH_COMPONENT32F, width_, height_);
  }
  for (GlTexture* layer : {&entries_, &exits_, &farEntries_, &farExits_})
    *layer = makeLayer(GL_RGBA32F, width_, height_);
  toOpaque_ = makeFramebuffer();
  glNamedFramebufferTexture(toOpaque_.name(), GL_COLOR_ATTACHMENT0, opaque_.name(), 0);
  glNamedFramebufferTexture(toOpaque_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
  requireComplete(toOpaque_);
  struct Attached {
    GlFramebuffer& framebuffer;
    const GlTexture& color;
    const GlRenderbuffer& depth;
  };
  for (const Attached& each :
       {Attached{toEntries_, entries_, entriesDepth_}, Attached{toExits_, exits_, exitsDepth_},
        Attached{toFarEntries_, farEntries_, farEntriesDepth_}, Attached{toFarExits_, farExits_, exitsDepth_},
        Attached{toAll_, all_, farEntriesDepth_}, Attached{toColors_, colors_, entriesDepth_}}) {
    each.framebuffer = makeFramebuffer();
    const GLuint name = each.framebuffer.name();
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, each.color.name(), 0);
    glNamedFramebufferRenderbuffer(name, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, each.depth.name());
    requireComplete(each.framebuffer);
  }
}

void WaterPass::drawFaces(const ShaderProgram& program, bool wet) const {
  program.use();
  const std::size_t offset = (wet ? static_cast<std::size_t>(freeIndices_) : 0) * sizeof(GLuint);
  glDrawElements(GL_TRIANGLES, wet ? wetIndices_ : freeIndices_, GL_UNSIGNED_INT,
                 std::bit_cast<const void*>(offset));
}

void WaterPass::drawLayer(const GlFramebuffer& into, GLenum culled, const GlTexture* before) const {
  glBindFramebuffer(GL_FRAMEBUFFER, into.name());
  // Where light leaves is also asked at pixels around the scissors' rectangle, where refracted rays come to.
  if (culled == GL_FRONT) glDisable(GL_SCISSOR_TEST);
  glClearNamedFramebufferfv(into.name(), GL_COLOR, 0, kNothing.data());
  glEnable(GL_SCISSOR_TEST);
  glClearNamedFramebufferfv(into.name(), GL_DEPTH, 0, &kFarthestDepth);
  glCullFace(culled);
  layer_.set("beyondLayer", before != nullptr ? 1 : 0);
  if (before != nullptr) glBindTextureUnit(2, before->name());
  for (const bool wet : {false, true}) {
    layer_.set("wet", wet ? 1 : 0);
    drawFaces(layer_, wet);
  }
}

void WaterPass::shade(const GlFramebuffer& into, const GlTexture& entries, const GlTexture& exits,
                      const GlTexture& behind) const {
  glBindFramebuffer(GL_FRAMEBUFFER, into.name());
  glBindTextureUnit(2, exits.name());
  glBindTextureUnit(3, behind.name());
  glBindTextureUnit(4, depth_.name());
  glBindTextureUnit(5, entries.name());
  // Only where the layer of entries, whose depth is attached, has something.
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  surface_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glEnable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

bool WaterPass::keepToWater(const WaterShot& shot) const {
  const Eigen::Vector2f low(-1, -1), high(1, 1);
  Eigen::Vector2f least = high, most = low;
  for (int k = 0; k < 8; ++k) {
    const Vec3d corner((k & 1) != 0 ? bounds_.max.x() : bounds_.min.x(),
                       (k & 2) != 0 ? bounds_.max.y() : bounds_.min.y(),
                       (k & 4) != 0 ? bounds_.max.z() : bounds_.min.z());
    const Eigen::Vector4f clip = shot.toClip * corner.cast<float>().homogeneous();
    if (clip.w() <= 0) {  // behind the eye: water may be anywhere
      least = low, most = high;
      break;
    }
    least = least.cwiseMin(clip.head<2>() / clip.w()), most = most.cwiseMax(clip.head<2>() / clip.w());
  }
  least = least.cwiseMax(low), most = most.cwiseMin(high);
  if ((least.array() > most.array()).any()) return false;
  constexpr int kMargin = 2;  // pixels
  std::array<GLint, 2> from, size;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const float begin = shot.viewport[axis], width = shot.viewport[axis + 2];
    const auto place = [&](float at) { return begin + (0.5F + 0.5F * at) * width; };
    from[axis] = std::max(static_cast<int>(place(least[i])) - kMargin, 0);
    size[axis] = static_cast<int>(place(most[i])) + 1 + kMargin - from[axis];
  }
  glScissor(from[0], from[1], size[0], size[1]);
  return true;
}

void WaterPass::draw(const RenderTarget& target, const WaterShot& shot) {
  if (freeIndices_ + wetIndices_ == 0) return;
  if (!keepToWater(shot)) return;
  resize(target);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glBindVertexArray(layout_.name());
  surface_.set("loss", shot.loss.x(), shot.loss.y(), shot.loss.z(), shot.groundHeight);
  // Rays come to anywhere in the picture.
  glDisable(GL_SCISSOR_TEST);
  target.copyScene(toOpaque_);
  glEnable(GL_SCISSOR_TEST);
  drawLayer(toEntries_, GL_BACK, nullptr);
  drawLayer(toExits_, GL_FRONT, nullptr);
  drawLayer(toFarEntries_, GL_BACK, &exits_);
  drawLayer(toFarExits_, GL_FRONT, &farEntries_);

  // The water behind the nearest, over what is behind both, all of which may be seen through it.
  glDisable(GL_SCISSOR_TEST);
  glBlitNamedFramebuffer(toOpaque_.name(), toAll_.name(), 0, 0, width_, height_, 0, 0, width_, height_,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
  // Where there are several samples a pixel, some drivers let pixels beside the scissors' rectangle through.
  glClearNamedFramebufferfv(toColors_.name(), GL_COLOR, 0, kNothing.data());
  glEnable(GL_SCISSOR_TEST);
  shade(toAll_, farEntries_, farExits_, opaque_);
  glGenerateTextureMipmap(all_.name());
  shade(toColors_, entries_, exits_, all_);

  target.continueScene();
  glBindTextureUnit(2, colors_.name());
  glBindTextureUnit(3, entries_.name());
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  cover_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace migiwa
