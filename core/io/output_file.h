// Files that are either whole or not there.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace migiwa {

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

}  // namespace migiwa
