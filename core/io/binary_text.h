// Numbers as bytes in a given order, whatever the machine's own.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

namespace migiwa {

/// Appends the four bytes of a float or a 32-bit integer.
template <std::endian kOrder, class T>
void appendBytes(std::string& text, T value) {
  static_assert(sizeof(T) == 4);
  auto bits = std::bit_cast<std::uint32_t>(value);
  if constexpr (kOrder != std::endian::native) bits = __builtin_bswap32(bits);
  char bytes[4];
  std::memcpy(bytes, &bits, 4);
  text.append(bytes, 4);
}

}  // namespace migiwa
