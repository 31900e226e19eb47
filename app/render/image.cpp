#include "app/render/image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <zlib.h>

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

namespace {

void appendNumber(std::string& bytes, std::size_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(number >> shift & 255U));
}

/// A chunk: its length, its kind of four letters, what it holds, a checksum of both.
void appendChunk(std::string& png, std::string_view kind, std::string_view content) {
  appendNumber(png, content.size());
  const std::size_t begin = png.size();
  png += kind;
  png += content;
  appendNumber(png, crc32(0, reinterpret_cast<const Bytef*>(png.data() + begin),
                          static_cast<uInt>(png.size() - begin)));
}

/// The rows without alpha, for pictures are opaque, each byte less the one above it: what most rows repeat.
std::vector<std::uint8_t> filteredRows(const Image& image) {
  constexpr std::uint8_t kLessAbove = 2;
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<std::uint8_t> rows(static_cast<std::size_t>(image.height) * (1 + 3 * width));
  std::vector<std::uint8_t> above(3 * width, 0), row(3 * width);
  std::uint8_t* to = rows.data();
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* from = image.pixel(0, y);
    for (std::size_t x = 0; x < width; ++x) std::copy_n(from + 4 * x, 3, row.data() + 3 * x);
    *to++ = kLessAbove;
    for (std::size_t k = 0; k < row.size(); ++k) *to++ = static_cast<std::uint8_t>(row[k] - above[k]);
    above.swap(row);
  }
  return rows;
}

}  // namespace

std::string encodePng(const Image& image, PngEffort effort) {
  const std::vector<std::uint8_t> rows = filteredRows(image);
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  std::string pixels(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(pixels.data()), &size, rows.data(), static_cast<uLong>(rows.size()),
                effort == PngEffort::least ? Z_BEST_SPEED : Z_DEFAULT_COMPRESSION) != Z_OK) {
    throw std::runtime_error("a picture of " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " pixels cannot be encoded");
  }
  pixels.resize(size);
  std::string header;
  appendNumber(header, static_cast<std::size_t>(image.width));
  appendNumber(header, static_cast<std::size_t>(image.height));
  header += std::string_view("\x08\x02\0\0\0", 5);  // eight bits of red, green and blue
  std::string png = "\x89PNG\r\n\x1A\n";
  appendChunk(png, "IHDR", header);
  appendChunk(png, "IDAT", pixels);
  appendChunk(png, "IEND", "");
  return png;
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

void RenderTarget::copyScene(const GlFramebuffer& to, GLbitfield what) const {
  glBlitNamedFramebuffer(scene_.name(), to.name(), 0, 0, width_, height_, 0, 0, width_, height_, what,
                         GL_NEAREST);
}

void RenderTarget::continueScene() const {
  glBindFramebuffer(GL_FRAMEBUFFER, scene_.name());
}

void RenderTarget::beginOverlay() const {
  copyScene(result_, GL_COLOR_BUFFER_BIT);
  glBindFramebuffer(GL_FRAMEBUFFER, result_.name());
}

void RenderTarget::beginOverlay(const RenderTarget& scene) const {
  scene.copyScene(scene.result_, GL_COLOR_BUFFER_BIT);
  glBlitNamedFramebuffer(scene.result_.name(), result_.name(), 0, 0, scene.width_, scene.height_, 0, 0,
                         width_, height_, GL_COLOR_BUFFER_BIT, GL_LINEAR);
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
  const int row = height_ - 1 - y;
  glBlitNamedFramebuffer(scene_.name(), result_.name(), x, row, x + 1, row + 1, x, row, x + 1, row + 1,
                         GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, result_.name());
  glReadPixels(x, row, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT, &depth);
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
