#include "app/raytrace/still.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include <Eigen/Geometry>

namespace migiwa {
namespace {

constexpr int kTile = 32;
/// Half the width of the tent by which samples count for a pixel (pixels).
constexpr float kTent = 0.8F;

/// In [-1, 1], with the density of a tent.
float tent(float unit) {
  return unit < 0.5F ? std::sqrt(2 * unit) - 1 : 1 - std::sqrt(2 - 2 * unit);
}

/// Rays of a camera through places of its picture.
class Lens {
 public:
  Lens(const Camera& camera, int width, int height) : eye_(camera.eye.cast<float>()) {
    const Vec3d ahead = (camera.target - camera.eye).normalized();
    const Vec3d right = ahead.cross(camera.up).normalized(), up = right.cross(ahead);
    const double tangent = std::tan(camera.fovDegrees * std::numbers::pi / 360);
    const double pixel = 2 * tangent / height;
    corner_ = (ahead - 0.5 * pixel * width * right + tangent * up).cast<float>();
    right_ = (pixel * right).cast<float>();
    down_ = (-pixel * up).cast<float>();
  }

  const Vec3f& eye() const { return eye_; }
  /// Through a place in pixels from the top left corner.
  Vec3f direction(float x, float y) const { return (corner_ + x * right_ + y * down_).normalized(); }

 private:
  Vec3f eye_, corner_, right_, down_;
};

/// Sums over the samples of a pixel, for a mean and the variance of that.
struct Scatter {
  float sum = 0, squares = 0;

  void add(float value) {
    sum += value;
    squares += value * value;
  }
  float mean(int count) const { return sum / static_cast<float>(count); }
  float variance(int count) const {
    const auto n = static_cast<float>(count);
    return count < 2 ? 0.0F : std::max(squares - sum * sum / n, 0.0F) / (n * (n - 1));
  }
};

Exposure emptyExposure(int width, int height) {
  Exposure result;
  result.width = width, result.height = height;
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (auto* halves : {&result.halves, &result.variances})
    for (auto& half : *halves)
      for (Channel& plane : half) plane.assign(count, 0);
  for (auto* guides : {&result.guides, &result.guideVariances})
    for (Channel& plane : *guides) plane.assign(count, 0);
  return result;
}

void exposePixel(const Stage& stage, const Lens& lens, const Place& start, const ExposureOptions& options,
                 std::uint32_t pixel, Exposure& result, PathCounts& counts) {
  std::array<std::array<Scatter, 3>, 2> light{};
  std::array<Scatter, Exposure::kGuides> guides{};
  const auto width = static_cast<std::uint32_t>(options.width);
  const auto x = static_cast<float>(pixel % width), y = static_cast<float>(pixel / width);
  for (int k = 0; k < options.samples; ++k) {
    PixelSamples random(options.seed, pixel, static_cast<std::uint32_t>(k),
                        static_cast<std::uint32_t>(options.samples));
    const auto [a, b] = random.next();
    const Vec3f direction = lens.direction(x + 0.5F + kTent * tent(a), y + 0.5F + kTent * tent(b));
    const PathSample sample = tracePath(stage, lens.eye(), direction, start, random, counts, options.bounces);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto axis = static_cast<Eigen::Index>(c);
      light[static_cast<std::size_t>(k & 1)][c].add(sample.radiance[axis]);
      guides[c].add(sample.normal[axis]);
      guides[3 + c].add(sample.albedo[axis]);
    }
    guides[6].add(std::log(1 + sample.distance / stage.extent()));
  }
  for (std::size_t half = 0; half < 2; ++half) {
    const int count = (options.samples + 1 - static_cast<int>(half)) / 2;
    for (std::size_t c = 0; c < 3; ++c) {
      result.halves[half][c][pixel] = light[half][c].mean(count);
      result.variances[half][c][pixel] = light[half][c].variance(count);
    }
  }
  for (std::size_t g = 0; g < Exposure::kGuides; ++g) {
    result.guides[g][pixel] = guides[g].mean(options.samples);
    result.guideVariances[g][pixel] = guides[g].variance(options.samples);
  }
}

}  // namespace

Exposure expose(const Stage& stage, const Camera& camera, const ExposureOptions& options, ThreadPool& pool) {
  Exposure result = emptyExposure(options.width, options.height);
  const Lens lens(camera, options.width, options.height);
  const Place start = stage.placeOf(lens.eye());
  const int across = (options.width + kTile - 1) / kTile, down = (options.height + kTile - 1) / kTile;
  const auto tiles = static_cast<std::size_t>(across * down);
  std::vector<PathCounts> counts(tiles);
  std::mutex progressMutex;
  std::size_t done = 0;
  pool.run(tiles, [&](std::size_t tile) {
    const int left = static_cast<int>(tile) % across * kTile, top = static_cast<int>(tile) / across * kTile;
    for (int y = top; y < std::min(top + kTile, options.height); ++y)
      for (int x = left; x < std::min(left + kTile, options.width); ++x)
        exposePixel(stage, lens, start, options, static_cast<std::uint32_t>(y * options.width + x), result,
                    counts[tile]);
    if (!options.progress) return;
    const std::lock_guard lock(progressMutex);
    options.progress(static_cast<double>(++done) / static_cast<double>(tiles));
  });
  for (const PathCounts& count : counts) result.counts.add(count);
  return result;
}

Radiance meanOf(const Exposure& exposure) {
  Radiance mean = exposure.halves[0];
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < mean[c].size(); ++i)
      mean[c][i] = 0.5F * (mean[c][i] + exposure.halves[1][c][i]);
  return mean;
}

namespace {

/// The curve of the Academy's reference rendering, fitted by Hill: a toe, nearly straight, and a shoulder
/// that lets highlights run out to white.
float filmCurve(float x) {
  return (x * (x + 0.0245786F) - 0.000090537F) / (x * (0.983729F * x + 0.4329510F) + 0.238081F);
}

std::uint8_t encoded(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  const float s = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

}  // namespace

std::vector<std::uint8_t> developed(const Radiance& radiance) {
  constexpr float kExposure = 1.5F;
  Eigen::Matrix3f toFilm, toScreen;
  toFilm << 0.59719F, 0.35458F, 0.04823F, 0.07600F, 0.90834F, 0.01566F, 0.02840F, 0.13383F, 0.83777F;
  toScreen << 1.60475F, -0.53108F, -0.07367F, -0.10208F, 1.10813F, -0.00605F, -0.00327F, -0.07276F, 1.07602F;
  const std::size_t count = radiance[0].size();
  std::vector<std::uint8_t> rgba(4 * count, 255);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3f light(radiance[0][i], radiance[1][i], radiance[2][i]);
    const Vec3f film = toFilm * (kExposure * light.cwiseMax(0.0F));
    const Vec3f screen = toScreen * Vec3f(film.unaryExpr(&filmCurve));
    for (std::size_t c = 0; c < 3; ++c) rgba[4 * i + c] = encoded(screen[static_cast<Eigen::Index>(c)]);
  }
  return rgba;
}

}  // namespace migiwa
