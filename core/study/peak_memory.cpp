#include "core/study/peak_memory.h"

#include <fstream>
#include <string>

#include <malloc.h>
#include <sys/resource.h>

namespace migiwa {

void resetPeakMemory() {
  malloc_trim(0);
  // proc(5): 5 sets the peak to what is resident now.
  std::ofstream("/proc/self/clear_refs") << 5;
}

double peakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace migiwa
