#include "core/scene/particle_limit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

namespace migiwa {

namespace {

constexpr double kLargestCount = 2147483647;  // particles are numbered with 32 bits, one of them for the sign
constexpr double kInfinite = std::numeric_limits<double>::infinity();

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

double firstNumber(const char* file) {
  std::ifstream in(file);
  double value = kInfinite;
  return in >> value ? value : kInfinite;  // cgroups write "max" for no limit
}

}  // namespace

double particleCount(const Scene& scene) {
  double particles = 0;
  for (const auto& source : scene.fluid) particles += source->count(scene.particleSpacing);
  for (const Emitter& emitter : scene.emitters)
    particles += emitter.count(scene.particleSpacing, scene.duration);
  return particles;
}

double availableMemory() {
  double available = kInfinite;
  std::ifstream in("/proc/meminfo");
  std::string key;
  double kibibytes = 0;
  while (in >> key >> kibibytes) {
    if (key == "MemAvailable:") available = kibibytes * 1024;
    std::getline(in, key);
  }
  // A container may have less than its machine.
  const double limit = firstNumber("/sys/fs/cgroup/memory.max");
  if (std::isfinite(limit))
    available = std::min(available, limit - std::min(limit, firstNumber("/sys/fs/cgroup/memory.current")));
  return available;
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
