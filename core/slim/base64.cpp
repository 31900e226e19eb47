#include "core/slim/base64.h"

#include <array>
#include <cstdint>

namespace migiwa {

namespace {
constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
}

std::string base64(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (k + i < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k + i]) : 0);
    for (std::size_t i = 0; i < 4; ++i)
      text.push_back(k + i > bytes.size() ? '=' : kDigits[group >> (18 - 6 * i) & 63]);
  }
  return text;
}

bool decodeBase64(std::string_view text, std::vector<std::byte>& bytes) {
  static const std::array<std::int8_t, 256> kValues = [] {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    for (std::size_t k = 0; k < kDigits.size(); ++k)
      values[static_cast<unsigned char>(kDigits[k])] = static_cast<std::int8_t>(k);
    return values;
  }();
  bytes.clear();
  if (text.size() % 4 != 0) return false;
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t k = 0; k < text.size(); k += 4) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int8_t value =
          k + i >= text.size() - padding ? std::int8_t{0} : kValues[static_cast<unsigned char>(text[k + i])];
      if (value < 0) return false;
      group = group << 6 | static_cast<std::uint32_t>(value);
    }
    for (std::size_t i = 0; i < 3; ++i) bytes.push_back(static_cast<std::byte>(group >> (16 - 8 * i) & 255));
  }
  bytes.resize(bytes.size() - padding);
  return true;
}

}  // namespace migiwa
