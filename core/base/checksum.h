// A checksum of what is kept on disk: tells a file that was damaged from one that is as it was written.
#pragma once

#include <cstddef>
#include <cstdint>

namespace migiwa {

inline constexpr std::uint64_t kEmptyChecksum = 0xCBF29CE484222325U;

/// Takes `bytes` bytes into a checksum: FNV-1a over words of eight bytes, the rest filled up with zeros. No
/// single word can change without changing it.
std::uint64_t checksum(std::uint64_t sum, const void* data, std::size_t bytes);

}  // namespace migiwa
