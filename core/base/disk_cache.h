// What takes seconds to make and depends on nothing but what it is made from, kept on disk for the next
// start.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

namespace migiwa {

/// $MIGIWA_CACHE, or migiwa in $XDG_CACHE_HOME or in ~/.cache; empty where there is none of these.
std::filesystem::path cacheFolder();

/// Writes a file whole or not at all, and creates its folder. Returns whether the file is now there.
bool writeCacheFile(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);

/// While there is one, what was kept is not read, on disk or in memory, so that all of it is made as if for
/// the first time, and kept anew: to measure how long that takes.
class MadeAnew {
 public:
  MadeAnew();
  ~MadeAnew();
  MadeAnew(const MadeAnew&) = delete;
  MadeAnew& operator=(const MadeAnew&) = delete;

  static bool active();
};

}  // namespace migiwa
