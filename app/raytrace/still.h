// Ray-traced pictures: many paths a pixel, their noise taken out, developed like a photograph.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "app/raytrace/paths.h"
#include "app/raytrace/stage.h"
#include "core/base/parallel.h"
#include "core/scene/scene.h"

namespace migiwa {

/// One number for each pixel, rows from the top.
using Channel = std::vector<float>;

/// What the paths of a picture have brought.
struct Exposure {
  static constexpr std::size_t kGuides = 7;  ///< normal, albedo, distance

  int width = 0, height = 0;
  /// Means of the even and of the odd samples: red, green, blue.
  std::array<std::array<Channel, 3>, 2> halves;
  /// Variances of those means, as the scatter of the samples has it.
  std::array<std::array<Channel, 3>, 2> variances;
  std::array<Channel, kGuides> guides;          ///< means over all samples
  std::array<Channel, kGuides> guideVariances;  ///< of those means
  PathCounts counts;
};

struct ExposureOptions {
  int width = 1280, height = 720;
  int samples = 64;  ///< of each pixel, at least 2
  std::uint32_t seed = 0;
  int bounces = 256;
  std::function<void(double part)> progress{};  ///< from one thread after the other; null: not told
};

/// Traces the paths, in tiles over the threads. The same for any number of threads.
Exposure expose(const Stage& stage, const Camera& camera, const ExposureOptions& options, ThreadPool& pool);

/// A picture in linear light: red, green, blue.
using Radiance = std::array<Channel, 3>;

/// The mean of all samples.
Radiance meanOf(const Exposure& exposure);
/// Takes the noise out: each half is averaged over pixels that look alike in the other half, by patches
/// [RKZ], and in what guides [RMZ].
Radiance denoised(const Exposure& exposure, ThreadPool& pool);

/// Eight bits a channel, sRGB, opaque: RGBA. Highlights run out as on film (the Academy's reference
/// rendering, as fitted by Hill).
std::vector<std::uint8_t> developed(const Radiance& radiance);

}  // namespace migiwa
