#include "core/base/disk_cache.h"

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

namespace migiwa {

namespace fs = std::filesystem;

namespace {

std::atomic<int> madeAnew{0};

}  // namespace

fs::path cacheFolder() {
  const auto set = [](const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? fs::path() : fs::path(value);
  };
  if (const fs::path own = set("MIGIWA_CACHE"); !own.empty()) return own;
  if (const fs::path cache = set("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "migiwa";
  if (const fs::path home = set("HOME"); home.is_absolute()) return home / ".cache" / "migiwa";
  return {};
}

bool writeCacheFile(const fs::path& file, const std::function<void(std::ostream&)>& write) {
  std::error_code code;
  fs::create_directories(file.parent_path(), code);
  // Under a name of this process alone: two that start at once do not write into each other's.
  fs::path temporary = file;
  temporary += "." + std::to_string(getpid()) + ".tmp";
  std::ofstream out(temporary, std::ios::binary);
  write(out);
  out.close();
  if (out) fs::rename(temporary, file, code);
  if (out && !code) return true;
  fs::remove(temporary, code);
  return false;
}

MadeAnew::MadeAnew() {
  ++madeAnew;
}
MadeAnew::~MadeAnew() {
  --madeAnew;
}
bool MadeAnew::active() {
  return madeAnew > 0;
}

}  // namespace migiwa
