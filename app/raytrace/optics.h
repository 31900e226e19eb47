// Light at smooth interfaces and within what is between them, and the random numbers that choose its ways.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/math.h"

namespace migiwa {

// Media and interfaces.

enum class Medium : std::uint8_t { air, water, glass };

inline float refractiveIndex(Medium medium) {
  return medium == Medium::water ? 1.333F : medium == Medium::glass ? 1.5F : 1.0F;
}

/// What is lost on a metre (1/m) where light that has gone `depth` (m) keeps the share `color`.
inline Vec3f lossOf(const Vec3d& color, double depth) {
  return (-color.array().log() / depth).matrix().cast<float>();
}

/// What a smooth interface between two dielectrics does with light.
struct Interface {
  float reflectance;  ///< of unpolarised light, in [0, 1]; 1 where none passes
  Vec3f refracted;    ///< unit; zero where none passes
};

/// `direction` (unit) is that of light in a medium of index `from`, `normal` (unit) points against it, the
/// index beyond is `to`. Fresnel's equations, exact, and Snell's law.
inline Interface interfaceAt(const Vec3f& direction, const Vec3f& normal, float from, float to) {
  const float ratio = from / to;
  const float cosine = std::fmin(-direction.dot(normal), 1.0F);
  const float sine2 = ratio * ratio * (1 - cosine * cosine);
  if (sine2 >= 1) return {1, Vec3f::Zero()};
  const float beyond = std::sqrt(1 - sine2);
  const float s = (from * cosine - to * beyond) / (from * cosine + to * beyond);
  const float p = (to * cosine - from * beyond) / (to * cosine + from * beyond);
  return {0.5F * (s * s + p * p), (ratio * direction + (ratio * cosine - beyond) * normal).normalized()};
}

inline Vec3f reflected(const Vec3f& direction, const Vec3f& normal) {
  return direction - 2 * direction.dot(normal) * normal;
}

// Random numbers of a pixel's samples: for each pair of dimensions a two-dimensional Sobol sequence, shuffled
// and scrambled by hashes ([Bur]). They depend on the seed, the pixel, the sample and the dimension alone.

inline std::uint32_t hashOf(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7FEB352DU;
  x ^= x >> 15;
  x *= 0x846CA68BU;
  return x ^ x >> 16;
}

class PixelSamples {
 public:
  /// `count` samples are taken: any set of so many is evenly spread.
  PixelSamples(std::uint32_t seed, std::uint32_t pixel, std::uint32_t sample, std::uint32_t count)
      : seed_(hashOf(pixel ^ hashOf(seed + 0x9E3779B9U))), sample_(sample) {
    while (mask_ < count - 1) mask_ = mask_ << 1U | 1U;
  }

  /// The next two dimensions, each in [0, 1).
  std::pair<float, float> next() {
    const std::uint32_t key = hashOf(seed_ + 0x9E3779B9U * ++dimension_);
    // A permutation of the low bits alone keeps the sequence short.
    const std::uint32_t index = reverse(scramble(reverse(sample_), key)) & mask_;
    std::uint32_t second = 0;
    std::uint32_t rest = index;
    for (std::uint32_t direction = 1U << 31U; rest != 0; rest >>= 1U, direction ^= direction >> 1U)
      if ((rest & 1U) != 0) second ^= direction;
    return {unit(scrambledFractions(reverse(index), hashOf(key ^ 0x68BC21EBU))),
            unit(scrambledFractions(second, hashOf(key ^ 0x02E5BE93U)))};
  }

 private:
  static std::uint32_t reverse(std::uint32_t x) {
    x = (x >> 1U & 0x55555555U) | (x & 0x55555555U) << 1U;
    x = (x >> 2U & 0x33333333U) | (x & 0x33333333U) << 2U;
    x = (x >> 4U & 0x0F0F0F0FU) | (x & 0x0F0F0F0FU) << 4U;
    x = (x >> 8U & 0x00FF00FFU) | (x & 0x00FF00FFU) << 8U;
    return x >> 16U | x << 16U;
  }
  /// Each bit flips by a hash of those below it.
  static std::uint32_t scramble(std::uint32_t x, std::uint32_t key) {
    x += key;
    x ^= x * 0x6C50B47CU;
    x ^= x * 0xB82F1E52U;
    x ^= x * 0xC7AFE638U;
    return x ^ x * 0x8D22F6E6U;
  }
  static std::uint32_t scrambledFractions(std::uint32_t x, std::uint32_t key) {
    return reverse(scramble(reverse(x), key));
  }
  static float unit(std::uint32_t x) { return static_cast<float>(x >> 8U) * 0x1p-24F; }

  std::uint32_t seed_, sample_, dimension_ = 0, mask_ = 0;
};

}  // namespace migiwa
