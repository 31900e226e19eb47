#include "core/base/hash.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/base/messages.h"

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

namespace fs = std::filesystem;

namespace {

bool isGltf(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".gltf";
}

bool isOrdinary(const fs::path& file) {
  std::error_code code;
  return fs::is_regular_file(file, code);
}

int hexValue(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const auto lower = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// "a%20b" as "a b".
std::string withoutEscapes(std::string_view uri) {
  std::string text;
  for (std::size_t k = 0; k < uri.size(); ++k) {
    const int high = k + 2 < uri.size() ? hexValue(uri[k + 1]) : -1;
    const int low = k + 2 < uri.size() ? hexValue(uri[k + 2]) : -1;
    if (uri[k] == '%' && high >= 0 && low >= 0) {
      text += static_cast<char>(16 * high + low);
      k += 2;
    } else {
      text += uri[k];
    }
  }
  return text;
}

/// Takes the bytes of a file into an identity.
void take(const fs::path& file, FileIdentity& identity) {
  if (!isOrdinary(file)) return;
  std::ifstream in(file, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 16);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0) {
    const auto count = static_cast<std::size_t>(in.gcount());
    identity.checksum = checksum(identity.checksum, piece.data(), count);
    identity.bytes += count;
  }
}

}  // namespace

std::string FileIdentity::text() const {
  return std::to_string(bytes) + " " + hexDigits(checksum);
}

std::vector<fs::path> filesOfShape(const fs::path& file) {
  std::vector<fs::path> files{file};
  if (!isGltf(file) || !isOrdinary(file)) return files;
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  const std::string_view text = content.view();
  constexpr std::string_view kKey = "\"uri\"";
  for (std::size_t at = text.find(kKey); at != std::string_view::npos; at = text.find(kKey, at)) {
    at += kKey.size();
    const std::size_t open = text.find_first_not_of(" \t\r\n:", at);
    if (open == std::string_view::npos || text[open] != '"') continue;
    const std::size_t close = text.find('"', open + 1);
    if (close == std::string_view::npos) break;
    const std::string_view uri = text.substr(open + 1, close - open - 1);
    at = close + 1;
    if (uri.empty() || uri.starts_with("data:")) continue;
    for (const std::string& name : {std::string(uri), withoutEscapes(uri)}) {
      const fs::path part = file.parent_path() / name;
      if (std::find(files.begin(), files.end(), part) == files.end()) files.push_back(part);
    }
  }
  return files;
}

FileIdentity identityOf(const std::vector<fs::path>& files) {
  FileIdentity identity{0, kEmptyChecksum};
  for (const fs::path& file : files) take(file, identity);
  return identity;
}

FileIdentity identityOf(const fs::path& file) {
  return identityOf(filesOfShape(file));
}

void requireUnchanged(const fs::path& file, const FileIdentity& identity) {
  if (identityOf(file) == identity) return;
  throw InputError(file.string(),
                   "expected a file that stays as it is while it is read, found one that was written to "
                   "meanwhile; try again");
}

}  // namespace migiwa
