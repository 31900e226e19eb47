#include "app/render/render_target.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace migiwa {
namespace {

void check(const GlFramebuffer& framebuffer) {
  if (glCheckNamedFramebufferStatus(framebuffer.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("the driver refuses a framebuffer with 4 samples and 32-bit depth");
  }
}

}  // namespace

RenderTarget::RenderTarget(int width, int height)
    : width_(width),
      height_(height),
      sceneColor_(makeRenderbuffer()),
      sceneDepth_(makeRenderbuffer()),
      depth_(makeRenderbuffer()),
      color_(makeTexture(GL_TEXTURE_2D)),
      scene_(makeFramebuffer()),
      result_(makeFramebuffer()) {
  glNamedRenderbufferStorageMultisample(sceneColor_.name(), kSamples, GL_RGBA8, width, height);
  glNamedRenderbufferStorageMultisample(sceneDepth_.name(), kSamples, GL_DEPTH_COMPONENT32F, width, height);
  glNamedFramebufferRenderbuffer(scene_.name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, sceneColor_.name());
  glNamedFramebufferRenderbuffer(scene_.name(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, sceneDepth_.name());
  glNamedRenderbufferStorage(depth_.name(), GL_DEPTH_COMPONENT32F, width, height);
  glTextureStorage2D(color_.name(), 1, GL_RGBA8, width, height);
  glNamedFramebufferTexture(result_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
  glNamedFramebufferRenderbuffer(result_.name(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
  check(scene_);
  check(result_);
}

void RenderTarget::beginScene() const {
  glBindFramebuffer(GL_FRAMEBUFFER, scene_.name());
  glViewport(0, 0, width_, height_);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void RenderTarget::beginOverlay() const {
  glBlitNamedFramebuffer(scene_.name(), result_.name(), 0, 0, width_, height_, 0, 0, width_, height_,
                         GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, result_.name());
}

Image RenderTarget::read() const {
  Image fromBottom(width_, height_), image(width_, height_);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, result_.name());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, fromBottom.rgba.data());
  const std::ptrdiff_t rowBytes = static_cast<std::ptrdiff_t>(width_) * 4;
  for (int row = 0; row < height_; ++row) {
    const std::uint8_t* from = fromBottom.pixel(0, height_ - 1 - row);
    std::copy(from, from + rowBytes, image.pixel(0, row));
  }
  // Blending leaves its own alpha behind, which a picture must not have.
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

std::optional<float> RenderTarget::depthAt(int x, int y) const {
  float depth = 1;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, result_.name());
  glReadPixels(x, height_ - 1 - y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
  if (depth >= 1) return std::nullopt;
  return depth;
}

void RenderTarget::copyToWindow(int windowWidth, int windowHeight) const {
  glBlitNamedFramebuffer(result_.name(), 0, 0, 0, width_, height_, 0, 0, windowWidth, windowHeight,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace migiwa
