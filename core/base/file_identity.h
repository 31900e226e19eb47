// What tells the content of a file from any other: the one identity of a file for all that is kept of it,
// such as fits, grids, saves and studies. Names and times are not part of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace migiwa {

struct FileIdentity {
  std::uint64_t bytes = 0;     ///< that were read; 0: nothing to read
  std::uint64_t checksum = 0;  ///< of these bytes, see core/base/checksum.h

  bool operator==(const FileIdentity&) const = default;
  /// Both numbers, with a space between.
  std::string text() const;
};

/// The file, and those that it refers to for a part of its shape: the buffers of a glTF file. Materials and
/// pictures do not count.
std::vector<std::filesystem::path> filesOfShape(const std::filesystem::path& file);

/// The identity of what is in these files now. Only ordinary files that can be read count.
FileIdentity identityOf(const std::vector<std::filesystem::path>& files);
/// That of filesOfShape().
FileIdentity identityOf(const std::filesystem::path& file);

/// Throws InputError where the content of the file is no longer that of `identity`: for whoever has just read
/// it and keeps what came of it under that identity.
void requireUnchanged(const std::filesystem::path& file, const FileIdentity& identity);

}  // namespace migiwa
