// Bytes as text (RFC 4648).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace migiwa {

std::string base64(std::span<const std::byte> bytes);
/// False unless `text` is base64 with its padding.
bool decodeBase64(std::string_view text, std::vector<std::byte>& bytes);

}  // namespace migiwa
