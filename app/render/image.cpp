#include "app/render/image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include <zlib.h>

namespace {

/// What stb_image_write asks of a compressor: `size` bytes into `*outSize` bytes that it frees. zlib writes a
/// fifth less than stb's own.
unsigned char* deflateForPng(unsigned char* bytes, int size, int* outSize, int /*quality*/) {
  uLongf length = compressBound(static_cast<uLong>(size));
  auto* out = static_cast<unsigned char*>(std::malloc(length));
  if (out == nullptr ||
      compress2(out, &length, bytes, static_cast<uLong>(size), Z_DEFAULT_COMPRESSION) != Z_OK) {
    std::free(out);
    return nullptr;
  }
  *outSize = static_cast<int>(length);
  return out;
}

}  // namespace

#define STBIW_ZLIB_COMPRESS deflateForPng
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb_image.h>

namespace migiwa {

void Image::paste(const Image& source, int x, int y) {
  for (int row = 0; row < source.height; ++row) {
    const std::uint8_t* from = source.pixel(0, row);
    std::copy(from, from + static_cast<std::ptrdiff_t>(source.width) * 4, pixel(x, y + row));
  }
}

std::optional<Image> readPng(const std::filesystem::path& file) {
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load(file.c_str(), &width, &height, &channels, 4), stbi_image_free);
  if (!pixels) return std::nullopt;
  Image image(width, height);
  std::copy_n(pixels.get(), image.rgba.size(), image.rgba.begin());
  return image;
}

std::string encodePng(const Image& image) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
  };
  // Pictures are opaque: a fourth byte a pixel would only take room.
  std::vector<std::uint8_t> rgb;
  rgb.reserve(image.rgba.size() / 4 * 3);
  for (std::size_t k = 0; k < image.rgba.size(); ++k)
    if (k % 4 != 3) rgb.push_back(image.rgba[k]);
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, rgb.data(), image.width * 3)) {
    throw std::runtime_error("a picture of " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " pixels cannot be encoded");
  }
  return bytes;
}

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

void RenderTarget::copyScene(const GlFramebuffer& to) const {
  glBlitNamedFramebuffer(scene_.name(), to.name(), 0, 0, width_, height_, 0, 0, width_, height_,
                         GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

void RenderTarget::continueScene() const {
  glBindFramebuffer(GL_FRAMEBUFFER, scene_.name());
}

void RenderTarget::beginOverlay() const {
  copyScene(result_);
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

namespace {

struct Point {
  double a, b;
};

/// The control points of a path through Oklab's colour plane: a cubic Bezier curve whose every point lies
/// inside sRGB at its lightness.
using Path = std::array<Point, 4>;
constexpr Path kCoolPath{{{-0.004, -0.125}, {-0.06, -0.06}, {-0.175, 0.05}, {-0.036, 0.168}}};
constexpr Path kWarmPath{{{0.065, -0.075}, {0.215, -0.045}, {0.165, 0.115}, {0.0, 0.085}}};

Point pathPoint(const Path& path, double t) {
  const double s = 1 - t;
  const std::array<double, 4> weight{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
  Point p{0, 0};
  for (std::size_t k = 0; k < 4; ++k) p.a += weight[k] * path[k].a, p.b += weight[k] * path[k].b;
  return p;
}

/// The path's points at equal distances along it.
std::vector<Point> evenPoints(const Path& path, int count) {
  constexpr int kPieces = 4096;
  std::vector<double> length{0};
  Point last = pathPoint(path, 0);
  for (int i = 1; i <= kPieces; ++i) {
    const Point p = pathPoint(path, static_cast<double>(i) / kPieces);
    length.push_back(length.back() + std::hypot(p.a - last.a, p.b - last.b));
    last = p;
  }
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    const double wanted = length.back() * i / (count - 1);
    const auto after = std::upper_bound(length.begin() + 1, length.end() - 1, wanted);
    const double piece = static_cast<double>(after - length.begin() - 1);
    points.push_back(pathPoint(path, (piece + (wanted - after[-1]) / (after[0] - after[-1])) / kPieces));
  }
  return points;
}

std::uint8_t encode(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  const double srgb = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

Rgb8 fromOklab(double lightness, const Point& p) {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lightness + 0.3963377774 * p.a + 0.2158037573 * p.b);
  const double m = cube(lightness - 0.1055613458 * p.a - 0.0638541728 * p.b);
  const double s = cube(lightness - 0.0894841775 * p.a - 1.2914855480 * p.b);
  return {encode(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          encode(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          encode(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

ColorMap makeMap(const Path& bends) {
  const std::vector<Point> path = evenPoints(bends, kColorMapSize);
  ColorMap map{};
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double t = static_cast<double>(i) / (kColorMapSize - 1);
    map[i] = fromOklab(kColorMapDarkest + (kColorMapLightest - kColorMapDarkest) * t, path[i]);
  }
  return map;
}

}  // namespace

ColorMap makeColorMap() {
  return makeMap(kCoolPath);
}

ColorMap makeWarmColorMap() {
  return makeMap(kWarmPath);
}

GlTexture makeColorTexture(const ColorMap& colors) {
  GlTexture texture = makeTexture(GL_TEXTURE_1D);
  glTextureStorage1D(texture.name(), 1, GL_SRGB8, kColorMapSize);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage1D(texture.name(), 0, 0, kColorMapSize, GL_RGB, GL_UNSIGNED_BYTE, colors.data());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  return texture;
}

GlTexture makePictureTexture(const Image& picture) {
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, GL_RGBA8, picture.width, picture.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture.name(), 0, 0, 0, picture.width, picture.height, GL_RGBA, GL_UNSIGNED_BYTE,
                      picture.rgba.data());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace migiwa
