#include "core/base/available_memory.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include <sys/resource.h>
#include <unistd.h>

#include "core/base/error.h"

namespace migiwa {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double firstNumber(const char* file) {
  std::ifstream in(file);
  double value = kInfinite;
  return in >> value ? value : kInfinite;  // cgroups write "max" for no limit
}

double ofMachine() {
  std::ifstream in("/proc/meminfo");
  std::string key;
  double kibibytes = 0;
  while (in >> key >> kibibytes) {
    if (key == "MemAvailable:") return kibibytes * 1024;
    std::getline(in, key);
  }
  return kInfinite;
}

double ofContainer() {
  const double limit = firstNumber("/sys/fs/cgroup/memory.max");
  return std::isfinite(limit) ? std::max(0.0, limit - firstNumber("/sys/fs/cgroup/memory.current"))
                              : kInfinite;
}

/// As `ulimit -v` sets it.
double ofProcess() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kInfinite;
  const double used = firstNumber("/proc/self/statm") * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - used);
}

}  // namespace

double availableMemory() {
  return std::min({ofMachine(), ofContainer(), ofProcess()});
}

void requireMemory(double bytes, const std::string& what, const std::string& place) {
  const double available = availableMemory();
  if (bytes <= available) return;
  constexpr double kMiB = 1024.0 * 1024;
  char text[200];
  std::snprintf(text, sizeof text,
                "expected %s with room in the %.0f MiB that are available, found that it needs %.0f MiB; a "
                "larger particle_spacing needs less",
                what.c_str(), available / kMiB, bytes / kMiB);
  throw InputError(place, text);
}

}  // namespace migiwa
