#include "app/render/renderer.h"

#include <algorithm>
#include <cmath>

#include "app/render/frame_uniforms.h"

namespace migiwa {
namespace {

/// Towards the camera along the clip axis: +1 or -1.
double clipSide(const Shot& shot) {
  return shot.camera.eye[static_cast<Eigen::Index>(shot.clip.axis)] >= shot.clip.at ? 1 : -1;
}

FrameUniforms makeUniforms(const Shot& shot, const Ground& ground, const RenderTarget& target) {
  const Projection projection = makeProjection(shot.camera, target.width(), target.height(), shot.scene);
  FrameUniforms uniforms{};
  uniforms.view = projection.view;
  uniforms.clip = projection.clip;
  for (Eigen::Index i = 0; i < 3; ++i) {
    uniforms.eye[static_cast<std::size_t>(i)] = static_cast<float>(shot.camera.eye[i]);
    uniforms.up[static_cast<std::size_t>(i)] = static_cast<float>(ground.up[i]);
  }
  if (shot.clip.enabled) {
    const double side = clipSide(shot);
    uniforms.clipPlane[static_cast<std::size_t>(shot.clip.axis)] = static_cast<float>(side);
    uniforms.clipPlane[3] = static_cast<float>(side * shot.clip.at);
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

}  // namespace

Renderer::Renderer(const Surroundings& surroundings, const ColorMap& colors)
    : ground_(makeGround(surroundings.bounds, surroundings.up)),
      spherePass_(colors),
      groundPass_(ground_),
      uniforms_(makeBuffer()) {
  linePass_.set(surroundings.walls);
  glNamedBufferStorage(uniforms_.name(), sizeof(FrameUniforms), nullptr, GL_DYNAMIC_STORAGE_BIT);
}

void Renderer::collectSpheres(const FrameView& frame, const Shot& shot) {
  colorFieldValues(frame, shot.color, values_);
  const auto low = static_cast<float>(shot.colorRange[0]);
  const auto scale = static_cast<float>(1 / (shot.colorRange[1] - shot.colorRange[0]));
  const auto side = static_cast<float>(clipSide(shot));
  const auto at = static_cast<float>(shot.clip.at);
  spheres_.clear();
  for (std::size_t i = 0; i < frame.positions.size(); ++i) {
    const Vec3f p = frame.positions[i].xyz();
    if (!p.allFinite()) continue;
    if (shot.clip.enabled && side * (p[static_cast<Eigen::Index>(shot.clip.axis)] - at) > 0) continue;
    const float value = (values_[i] - low) * scale;
    spheres_.emplace_back(p, value > 0 ? std::min(value, 1.0F) : 0.0F);  // 0 for what is not a number, too
  }
}

void Renderer::draw(const FrameView& frame, const Shot& shot, const RenderTarget& target) {
  const FrameUniforms uniforms = makeUniforms(shot, ground_, target);
  glNamedBufferSubData(uniforms_.name(), 0, sizeof(uniforms), &uniforms);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_.name());
  glViewport(static_cast<GLint>(uniforms.viewport[0]), static_cast<GLint>(uniforms.viewport[1]),
             shot.scene.width, shot.scene.height);
  glEnable(GL_MULTISAMPLE);
  glDisable(GL_CULL_FACE);

  if (frame.info.walls && frame.info.walls != movedWalls_) {
    movedWalls_ = frame.info.walls;
    linePass_.set(*movedWalls_);
  }
  collectSpheres(frame, shot);
  const float radius = 0.5F * frame.info.spacing;
  groundPass_.draw(spheres_, radius, shot.camera.eye);
  spherePass_.draw(spheres_, radius);
  if (shot.walls) linePass_.draw(std::max(1.2F, static_cast<float>(target.height()) / 480));
}

}  // namespace migiwa
