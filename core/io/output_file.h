// Text files that are either whole or not there.
#pragma once

#include <filesystem>
#include <string_view>

namespace migiwa {

/// Throws InputError at `option` unless writeTextFile could write `file`. Leaves nothing behind. For the
/// start of a run whose result goes there.
void requireWritable(const std::filesystem::path& file, std::string_view option);

/// Writes under a temporary name beside `file`, then renames it; a device or pipe is written straight away.
/// Throws std::runtime_error when that fails.
void writeTextFile(const std::filesystem::path& file, std::string_view text);

}  // namespace migiwa
