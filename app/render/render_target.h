// The framebuffer that every picture is drawn into, in a window and without one, so that both give the same
// bytes: four samples a pixel, resolved to a texture that text and panels are then drawn over.
#pragma once

#include <optional>

#include "app/render/gl_objects.h"
#include "app/render/image.h"

namespace migiwa {

inline constexpr int kSamples = 4;

class RenderTarget {
 public:
  RenderTarget(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Binds the multisampled buffer and clears it.
  void beginScene() const;
  /// Resolves it and binds the result.
  void beginOverlay() const;
  /// The finished picture, opaque.
  Image read() const;
  /// Depth in [0, 1] at a pixel counted from the top left; nothing where nothing was drawn.
  std::optional<float> depthAt(int x, int y) const;
  /// Copies the finished picture to the current window's framebuffer.
  void copyToWindow(int windowWidth, int windowHeight) const;

 private:
  int width_, height_;
  GlRenderbuffer sceneColor_, sceneDepth_, depth_;
  GlTexture color_;
  GlFramebuffer scene_, result_;
};

}  // namespace migiwa
