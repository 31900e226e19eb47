// Hashes: checksums of files, the identity of a file by its content, and the hash of a state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/math.h"
#include "core/base/parallel.h"

namespace migiwa {

// A checksum of what is kept on disk: tells a file that was damaged from one that is as it was written.

inline constexpr std::uint64_t kEmptyChecksum = 0xCBF29CE484222325U;

/// Takes `bytes` bytes into a checksum: FNV-1a over words of eight bytes, the rest filled up with zeros. No
/// single word can change without changing it.
std::uint64_t checksum(std::uint64_t sum, const void* data, std::size_t bytes);

// A hash of what a simulation's future depends on. It sums over particles, so neither their order nor the
// number of threads matters; one changed bit changes it.

std::uint64_t stateHash(std::span<const std::uint32_t> ids, std::span<const Float4> positions,
                        std::span<const Float4> velocities, ThreadPool& pool);

/// A hash as people read it: 16 hexadecimal digits.
std::string hexDigits(std::uint64_t hash);

// What tells the content of a file from any other: the one identity of a file for all that is kept of it,
// such as fits, grids, saves and studies. Names and times are not part of it.

struct FileIdentity {
  std::uint64_t bytes = 0;     ///< that were read; 0: nothing to read
  std::uint64_t checksum = 0;  ///< of these bytes, as above

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
