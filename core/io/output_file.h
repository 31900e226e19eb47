// Files that are either whole or not there.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace migiwa {

/// Throws InputError at `option` unless writeFile could write `file`. Leaves nothing behind. For the start of
/// a run whose result goes there.
void requireWritable(const std::filesystem::path& file, std::string_view option);

/// What a new file has to outlast before it takes the place of an old one.
enum class Outlasting {
  theProgram,  ///< its end at any time
  theMachine,  ///< a power cut, too: waits for the disk
};

/// Writes the pieces one after another under a temporary name beside `file`, then renames it; a device or
/// pipe is written straight away. When that fails, throws InputError at the file with the reason, and an
/// older file of that name stays as it was.
void writeFile(const std::filesystem::path& file, std::span<const std::string_view> pieces,
               Outlasting outlasting);

/// The same for one text.
void writeTextFile(const std::filesystem::path& file, std::string_view text);

}  // namespace migiwa
