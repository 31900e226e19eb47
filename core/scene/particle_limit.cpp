#include "core/scene/particle_limit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace migiwa {

namespace {

/// Neighbours are listed by their offsets in bytes, of 16 a particle, in 32 bits; one place is for the ghost.
constexpr double kLargestCount = 268435455;

/// With so many significant digits, and never fewer than the whole ones unless there are very many.
std::string digits(double value, int significant) {
  char text[64];
  if (value >= 100 && value < 1e9) {
    std::snprintf(text, sizeof text, "%.0f", value);
  } else {
    std::snprintf(text, sizeof text, "%.*g", significant, value);
  }
  return text;
}

}  // namespace

double particleCount(const Scene& scene) {
  double particles = 0;
  for (const auto& source : scene.fluid) particles += source->count(scene.particleSpacing);
  for (const Emitter& emitter : scene.emitters)
    particles += emitter.count(scene.particleSpacing, scene.duration);
  return particles;
}

std::optional<std::string> tooManyParticles(double particles, double spacing, double memory) {
  const double most = std::min(kLargestCount, std::floor(memory / kBytesPerParticle));
  if (particles <= most) return std::nullopt;
  const bool byMemory = most < kLargestCount;
  constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
  std::string text = "expected a spacing that makes at most " + digits(most, 2) + " particles" +
                     (byMemory ? " (" + digits(memory / kGiB, 2) + " GiB are available)" : "") + ", found " +
                     digits(spacing, 6) + " m, which makes " + digits(particles, 2) +
                     (byMemory ? " (about " + digits(particles * kBytesPerParticle / kGiB, 2) + " GiB)" : "");
  if (most > 0) {
    // The count goes with the spacing to the power of -3; a little more, rounded up to two digits, is on the
    // safe side.
    const double enough = 1.02 * spacing * std::cbrt(particles / most);
    const double unit = std::pow(10, std::floor(std::log10(enough)) - 1);
    text += "; a spacing of " + digits(std::ceil(enough / unit) * unit, 2) + " m would do";
  }
  return text;
}

}  // namespace migiwa
