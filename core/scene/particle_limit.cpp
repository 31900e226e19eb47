#include "core/scene/particle_limit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace migiwa {

namespace {

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

/// Quotients of decimal numbers miss whole ones by what a double cannot hold.
constexpr double kRounding = 1e-10;

/// A spacing (m) of two digits that makes at most so many particles; nothing where there is none below the
/// largest that a scene may have.
std::optional<double> coarseEnough(const std::function<double(double)>& count, double spacing, double most) {
  constexpr double kLargestSpacing = 1e3;
  // The count of a solid goes with the spacing to the power of -3, that of thin things with a lower one.
  double enough = 1.02 * spacing * std::cbrt(count(spacing) / most);
  while (enough <= kLargestSpacing) {
    const double rounded = shownRoundedUp(enough);
    if (count(rounded) <= most) return rounded;
    enough = 1.05 * rounded;
  }
  return std::nullopt;
}

}  // namespace

double shownRoundedUp(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::ceil((1 - kRounding) * value / unit) * unit;
}

double shownRoundedDown(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::floor((1 + kRounding) * value / unit) * unit;
}

double mostParticles(double memory) {
  return std::min(kLargestCount, std::floor(memory / kBytesPerParticle));
}

double particleCount(const Scene& scene, double spacing, double time) {
  double particles = 0;
  for (const auto& source : scene.fluid) particles += source->count(spacing);
  for (const Emitter& emitter : scene.emitters) particles += emitter.count(spacing, time);
  return particles;
}

double particleCount(const Scene& scene) {
  return particleCount(scene, scene.particleSpacing, scene.duration);
}

std::optional<std::string> tooManyParticles(const std::function<double(double)>& count, double spacing,
                                            double memory) {
  const double particles = count(spacing), most = mostParticles(memory);
  if (particles <= most) return std::nullopt;
  const bool byMemory = most < kLargestCount;
  constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
  std::string text = "expected a spacing that makes at most " + digits(most, 2) + " particles" +
                     (byMemory ? " (" + digits(memory / kGiB, 2) + " GiB are available)" : "") + ", found " +
                     digits(spacing, 6) + " m, which makes " + digits(particles, 2) +
                     (byMemory ? " (about " + digits(particles * kBytesPerParticle / kGiB, 2) + " GiB)" : "");
  if (const auto enough = most > 0 ? coarseEnough(count, spacing, most) : std::nullopt)
    text += "; a spacing of " + digits(*enough, 2) + " m would do";
  return text;
}

std::optional<std::string> tooManyParticles(double particles, double spacing, double memory) {
  return tooManyParticles([=](double other) { return particles * std::pow(spacing / other, 3); }, spacing,
                          memory);
}

}  // namespace migiwa
