#include "core/base/checksum.h"

#include <algorithm>
#include <cstring>

namespace migiwa {

std::uint64_t checksum(std::uint64_t sum, const void* data, std::size_t bytes) {
  const auto* at = static_cast<const char*>(data);
  for (std::size_t k = 0; k < bytes; k += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at + k, std::min<std::size_t>(8, bytes - k));
    sum = (sum ^ word) * 0x100000001B3U;
    sum ^= sum >> 29;
  }
  return sum;
}

}  // namespace migiwa
