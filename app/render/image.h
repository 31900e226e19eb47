// Pictures: in memory, as PNG, as what is drawn into, and the colours of fields.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/render/gl.h"

namespace migiwa {

// A picture in memory.

/// Eight bits a channel, rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), rgba(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 4) {}

  std::uint8_t* pixel(int x, int y) { return rgba.data() + offset(x, y); }
  const std::uint8_t* pixel(int x, int y) const { return rgba.data() + offset(x, y); }
  /// Copies `source` to where its top left corner is (x, y); it must fit.
  void paste(const Image& source, int x, int y);

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 4;
  }
};

// Pictures as PNG; the same picture always gives the same bytes.

/// How long it takes to make a PNG file, and how small it gets.
enum class PngEffort {
  least,  ///< for what is read again soon: a third larger
  usual
};
/// The bytes of a PNG file, without alpha.
std::string encodePng(const Image& image, PngEffort effort = PngEffort::usual);
/// Nothing where there is no such file, or it is none.
std::optional<Image> readPng(const std::filesystem::path& file);

// The framebuffer that every picture is drawn into, in a window and without one, so that both give the same
// bytes: four samples a pixel, resolved to a texture that text and panels are then drawn over.

inline constexpr int kSamples = 4;

class RenderTarget {
 public:
  RenderTarget(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Binds the multisampled buffer and clears it.
  void beginScene() const;
  /// Copies what it holds so far, resolved, to a framebuffer of the same size: colours, depth (32-bit), or
  /// both.
  void copyScene(const GlFramebuffer& to, GLbitfield what = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT) const;
  /// Binds it again.
  void continueScene() const;
  /// Resolves it and binds the result.
  void beginOverlay() const;
  /// The same, with what another target holds, brought to this one's size.
  void beginOverlay(const RenderTarget& scene) const;
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

// Our colour maps. Of particles: dark blue, teal, green, yellow. Built in Oklab (Ottosson 2020) so that equal
// steps of the value look equally far apart: lightness rises linearly, and the path through the colour plane
// is walked at constant speed. Of SLIM nodes: the same from plum over red and orange to a pale yellow, so
// that it is never taken for the particles'.

inline constexpr int kColorMapSize = 256;
using Rgb8 = std::array<std::uint8_t, 3>;
/// sRGB-encoded colours from the low end to the high end.
using ColorMap = std::array<Rgb8, kColorMapSize>;

/// Oklab lightness of the two ends.
inline constexpr double kColorMapDarkest = 0.32;
inline constexpr double kColorMapLightest = 0.92;

ColorMap makeColorMap();
ColorMap makeWarmColorMap();

// A colour map as a texture that interpolates between its entries in linear light.

GlTexture makeColorTexture(const ColorMap& colors);

/// A picture as a texture for panels, which draw its values as they are.
GlTexture makePictureTexture(const Image& picture);

}  // namespace migiwa
