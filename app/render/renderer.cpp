#include "app/render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace migiwa {
namespace {

using Ink = std::array<float, 4>;
constexpr Ink kWallInk{0.16F, 0.22F, 0.30F, 0.9F}, kSectionInk{0.16F, 0.22F, 0.30F, 1},
    kMouthInk{0.02F, 0.42F, 0.62F, 0.9F}, kDrainInk{0.72F, 0.27F, 0.12F, 0.9F};

FrameUniforms makeUniforms(const Shot& shot, const Ground& ground, const RenderTarget& target) {
  const Projection projection = makeProjection(shot.camera, target.width(), target.height(), shot.scene);
  FrameUniforms uniforms{};
  uniforms.view = projection.view;
  uniforms.clip = projection.clip;
  for (Eigen::Index i = 0; i < 3; ++i) {
    uniforms.eye[static_cast<std::size_t>(i)] = static_cast<float>(shot.camera.eye[i]);
    uniforms.up[static_cast<std::size_t>(i)] = static_cast<float>(ground.up[i]);
  }
  if (const std::optional<CutPlane> cut = cutOf(shot)) {
    for (Eigen::Index i = 0; i < 3; ++i)
      uniforms.clipPlane[static_cast<std::size_t>(i)] = static_cast<float>(cut->normal[i]);
    uniforms.clipPlane[3] = static_cast<float>(cut->at);
  } else {
    uniforms.clipPlane[3] = 1;
  }
  uniforms.viewport = {static_cast<float>(shot.scene.x),
                       static_cast<float>(target.height() - shot.scene.y - shot.scene.height),
                       static_cast<float>(shot.scene.width), static_cast<float>(shot.scene.height)};
  for (GLuint i = 0; i < kSamples; ++i) {
    float* place = &uniforms.samples[std::size_t{2} * i];
    glGetMultisamplefv(GL_SAMPLE_POSITION, i, place);
    place[0] -= 0.5F, place[1] -= 0.5F;
  }
  return uniforms;
}

/// The triangles that face the ground, with the area that each covers of it.
std::vector<Float4> groundPatches(std::span<const WallMesh> meshes, const Vec3f& up) {
  std::vector<Float4> patches;
  for (const WallMesh& mesh : meshes) {
    const float side = mesh.vessel ? -1.0F : 1.0F;
    for (const auto& [a, b, c] : mesh.surface.triangles) {
      const Vec3f &p = mesh.surface.vertices[a], &q = mesh.surface.vertices[b], &r = mesh.surface.vertices[c];
      const float covered = -side * 0.5F * up.dot((q - p).cross(r - p));
      if (covered > 0) patches.emplace_back((p + q + r) / 3, covered);
    }
  }
  return patches;
}

}  // namespace

std::optional<CutPlane> cutOf(const Shot& shot) {
  CutPlane plane;
  if (shot.cut) {
    plane = *shot.cut;
  } else if (shot.clip.enabled) {
    plane = {Vec3d::Unit(static_cast<Eigen::Index>(shot.clip.axis)), shot.clip.at};
  } else {
    return std::nullopt;
  }
  if (plane.normal.dot(shot.camera.eye) >= plane.at) return plane;
  return CutPlane{-plane.normal, -plane.at};
}

bool isCut(const Shot& shot, const Vec3f& p) {
  const std::optional<CutPlane> cut = cutOf(shot);
  return cut && cut->normal.dot(p.cast<double>()) > cut->at;
}

Renderer::Renderer(const Surroundings& surroundings, const ColorMap& colors)
    : ground_(makeGround(surroundings.bounds, surroundings.up)),
      spherePass_(colors),
      groundPass_(ground_),
      uniforms_(makeBuffer()) {
  setWalls(surroundings.walls);
  mouthPass_.set(surroundings.mouths);
  drainPass_.set(surroundings.drains);
  glNamedBufferStorage(uniforms_.name(), sizeof(FrameUniforms), nullptr, GL_DYNAMIC_STORAGE_BIT);
}

void Renderer::setWalls(const WallDrawing& walls) {
  linePass_.set(walls.lines);
  meshes_ = walls.meshes;
  surfacePass_.set(meshes_);
  patches_ = groundPatches(meshes_, ground_.up.cast<float>());
  sectionOf_.reset();
  nodePass_.set(walls.nodes);
}

void Renderer::collectSpheres(const FrameView& frame, const Shot& shot) {
  colorFieldValues(frame, shot.color, values_);
  const auto low = static_cast<float>(shot.colorRange[0]);
  const auto scale = static_cast<float>(1 / (shot.colorRange[1] - shot.colorRange[0]));
  spheres_.clear();
  for (std::size_t i = 0; i < frame.positions.size(); ++i) {
    const Vec3f p = frame.positions[i].xyz();
    if (!p.allFinite() || isCut(shot, p)) continue;
    const float value = (values_[i] - low) * scale;
    spheres_.emplace_back(p, value > 0 ? std::min(value, 1.0F) : 0.0F);  // 0 for what is not a number, too
  }
}

void Renderer::collectPatches(const Shot& shot) {
  shownPatches_.clear();
  if (!shot.walls) return;
  for (const Float4& patch : patches_)
    if (!isCut(shot, patch.xyz())) shownPatches_.push_back(patch);
}

void Renderer::drawSection(const Shot& shot, float width) {
  std::optional<CutPlane> cut = cutOf(shot);
  if (!cut || meshes_.empty()) return;
  // A hair behind the plane, on what it leaves.
  cut->at -= 1e-5 * ground_.extent;
  if (sectionOf_ != cut) {
    sectionPass_.set(sectionLines(meshes_, *cut));
    sectionOf_ = cut;
  }
  sectionPass_.draw(width, kSectionInk);
}

void Renderer::draw(const FrameView& frame, const Shot& asked, const RenderTarget& target) {
  Shot shot = asked;
  if (frame.water) shot.clip.enabled = false, shot.cut.reset();
  const FrameUniforms uniforms = makeUniforms(shot, ground_, target);
  glNamedBufferSubData(uniforms_.name(), 0, sizeof(uniforms), &uniforms);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_.name());
  glViewport(static_cast<GLint>(uniforms.viewport[0]), static_cast<GLint>(uniforms.viewport[1]),
             shot.scene.width, shot.scene.height);
  glEnable(GL_MULTISAMPLE);
  glDisable(GL_CULL_FACE);

  if (frame.walls && frame.walls != movedWalls_) {
    movedWalls_ = frame.walls;
    setWalls(*movedWalls_);
  }
  collectSpheres(frame, shot);
  collectPatches(shot);
  const float radius = 0.5F * frame.info.spacing;
  // Water lets most of the light through that particles keep off.
  groundPass_.draw(spheres_, frame.water ? 0.3F * radius : radius, shownPatches_, shot.camera.eye);
  if (!frame.water) spherePass_.draw(spheres_, radius);
  if (shot.sheet) drawSheet(shot);
  const float width = std::max(1.2F, static_cast<float>(target.height()) / 480);
  if (shot.walls && shot.nodes) nodePass_.draw();
  if (shot.walls && !shot.nodes) {
    surfacePass_.drawOpaque();
    drawSection(shot, 1.4F * width);
  }
  if (frame.water) {
    if (shot.walls) drawLines(width);  // those behind the water, which are seen through it
    drawWater(frame, shot, uniforms, target);
  }
  if (!shot.walls) return;
  drawLines(width);
  if (!shot.nodes) surfacePass_.drawGlass();
}

void Renderer::drawLines(float width) const {
  linePass_.draw(width, kWallInk);
  mouthPass_.draw(width, kMouthInk);
  drainPass_.draw(width, kDrainInk);
}

void Renderer::drawSheet(const Shot& shot) {
  if (!sheetPass_) sheetPass_.emplace();
  if (shot.sheet != sheet_) {
    sheet_ = shot.sheet;
    sheetPass_->set(*sheet_);
  }
  sheetPass_->draw();
}

void Renderer::drawWater(const FrameView& frame, const Shot& shot, const FrameUniforms& uniforms,
                         const RenderTarget& target) {
  if (!waterPass_) waterPass_.emplace();
  if (frame.water != water_) {
    water_ = frame.water;
    waterPass_->set(*water_);
  }
  waterPass_->draw(target, {uniforms.clip * uniforms.view, uniforms.viewport, shot.waterLoss,
                            static_cast<float>(ground_.center.dot(ground_.up))});
}

std::vector<LineSegment> sectionLines(std::span<const WallMesh> meshes, const CutPlane& plane) {
  const Vec3f normal = plane.normal.cast<float>();
  const auto at = static_cast<float>(plane.at);
  std::vector<LineSegment> lines;
  for (const WallMesh& mesh : meshes) {
    for (const auto& corners : mesh.surface.triangles) {
      std::array<Vec3f, 2> ends;
      std::size_t found = 0;
      for (std::size_t k = 0; k < 3 && found < 2; ++k) {
        const Vec3f& from = mesh.surface.vertices[corners[k]];
        const Vec3f& to = mesh.surface.vertices[corners[(k + 1) % 3]];
        const float before = normal.dot(from) - at, after = normal.dot(to) - at;
        if ((before < 0) == (after < 0)) continue;
        ends[found++] = from + before / (before - after) * (to - from);
      }
      if (found == 2) lines.push_back({ends[0], ends[1]});
    }
  }
  return lines;
}

}  // namespace migiwa
