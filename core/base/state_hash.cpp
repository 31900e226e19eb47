#include "core/base/state_hash.h"

#include <bit>
#include <cstdio>

namespace migiwa {

namespace {

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every input bit reaches every output bit.
std::uint64_t mix(std::uint64_t v) {
  v += 0x9E3779B97F4A7C15U;
  v = (v ^ (v >> 30)) * 0xBF58476D1CE4E5B9U;
  v = (v ^ (v >> 27)) * 0x94D049BB133111EBU;
  return v ^ (v >> 31);
}

std::uint64_t bits(float low, float high) {
  return std::bit_cast<std::uint32_t>(low) | static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(high))
                                                 << 32;
}

}  // namespace

std::uint64_t stateHash(std::span<const std::uint32_t> ids, std::span<const Float4> positions,
                        std::span<const Float4> velocities, ThreadPool& pool) {
  return parallelReduce(
      pool, ids.size(), std::uint64_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::uint64_t sum = 0;
        for (std::size_t i = begin; i < end; ++i) {
          const Float4 &x = positions[i], &v = velocities[i];
          std::uint64_t hash = mix(ids[i]);
          hash = mix(hash ^ bits(x.x, x.y));
          hash = mix(hash ^ bits(x.z, v.x));
          hash = mix(hash ^ bits(v.y, v.z));
          sum += hash;
        }
        return sum;
      },
      [](std::uint64_t a, std::uint64_t b) { return a + b; });
}

std::string hexDigits(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace migiwa
