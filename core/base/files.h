// Files and memory: a cache on disk, output that is whole or not there, and how much memory is left.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace migiwa {

// What takes seconds to make and depends on nothing but what it is made from, kept on disk for the next
// start.

/// $MIGIWA_CACHE, or migiwa in $XDG_CACHE_HOME or in ~/.cache; empty where there is none of these.
std::filesystem::path cacheFolder();

/// Writes a file whole or not at all, and creates its folder. Returns whether the file is now there.
bool writeCacheFile(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write);

/// While there is one, what was kept is not read, on disk or in memory, so that all of it is made as if for
/// the first time, and kept anew: to measure how long that takes.
class CacheBypass {
 public:
  CacheBypass();
  ~CacheBypass();
  CacheBypass(const CacheBypass&) = delete;
  CacheBypass& operator=(const CacheBypass&) = delete;

  static bool active();
};

/// The last results of something that takes long, by what they are made from: comparisons and restarts read
/// the same scene again and again. Whoever asks while another's is made waits. What is made depends on the
/// key alone, so nobody sees a difference.
template <class Key, class Result>
class KeptResults {
 public:
  explicit KeptResults(std::size_t most) : most_(most) {}

  template <class Make>
  Result get(const Key& key, const Make& make) {
    const std::lock_guard lock(mutex_);
    if (!CacheBypass::active())
      for (const auto& [known, result] : kept_)
        if (known == key) return result;
    kept_.emplace_front(key, make(key));
    if (kept_.size() > most_) kept_.pop_back();
    return kept_.front().second;
  }

 private:
  std::size_t most_;
  std::mutex mutex_;
  std::deque<std::pair<Key, Result>> kept_;
};

// Files that are either whole or not there.

/// Throws what a failure to write `place` is: InputError for a path that cannot be written (no such folder, a
/// folder, no permission), OutputError where the machine has no room or fails.
[[noreturn]] void throwNotWritten(const std::string& place, const std::error_code& reason);

/// Throws InputError at `option` unless writeFile could write `file`, OutputError where there is no room for
/// even an empty one. Leaves nothing behind. For the start of a run whose result goes there.
void requireWritable(const std::filesystem::path& file, std::string_view option);

/// Makes a folder, and those around it, unless it is there. Throws InputError at `option` where there can be
/// none, OutputError where the machine has no room for it.
void makeFolder(const std::filesystem::path& folder, std::string_view option);

/// What a new file has to outlast before it takes the place of an old one.
enum class Outlasting {
  theProgram,  ///< its end at any time
  theMachine,  ///< a power cut, too: waits for the disk
};

/// Writes the pieces one after another under a temporary name beside `file`, then renames it; a device or
/// pipe is written straight away. When that fails, throws as throwNotWritten() at the file, and an older file
/// of that name stays as it was.
void writeFile(const std::filesystem::path& file, std::span<const std::string_view> pieces,
               Outlasting outlasting);

/// The same for one text.
void writeTextFile(const std::filesystem::path& file, std::string_view text);

// What memory can still be had, asked before much of it is taken: a program that the system has to stop for
// want of memory says nothing.

/// Memory that can still be had (bytes): of the machine, of the container and of the process. Infinite where
/// the system does not say.
double availableMemory();

/// Throws InputError at `place` where `bytes` for `what` are more than can still be had.
void requireMemory(double bytes, const std::string& what, const std::string& place);

// The largest amount of memory that the program has had since it last asked, so that runs in one program are
// told apart.

/// Gives back what is free and starts anew from what is in use. Where the system cannot do this, the peak
/// stays that of the whole program.
void resetPeakMemory();
/// Largest resident set since then (bytes).
double peakMemory();

/// The whole file. Throws InputError when there is none, when it is a folder, too large or cannot be read.
/// `kind` says what was expected, such as "a scene file".
std::string readTextFile(const std::filesystem::path& file, std::string_view kind);

}  // namespace migiwa
