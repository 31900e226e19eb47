#include "core/slim/ply_check.h"

#include <algorithm>
#include <cstdint>
#include <sstream>

namespace migiwa {

namespace {

/// Bytes of a number in a binary file; 0 for a type that is none.
std::size_t bytesOf(const std::string& type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "int32" || type == "uint32") return 4;
  if (type == "float" || type == "float32") return 4;
  if (type == "double" || type == "float64") return 8;
  return 0;
}

}  // namespace

std::string plyFault(std::string_view content) {
  if (!content.starts_with("ply")) return "expected a PLY file, found one that does not begin with \"ply\"";
  const std::size_t end = content.find("end_header");
  const std::size_t body = end == std::string_view::npos ? end : content.find('\n', end);
  if (body == std::string_view::npos) return "expected a PLY file, found one that ends within its header";

  bool ascii = false;
  std::uint64_t elements = 0;          // of the kind whose properties follow
  std::uint64_t lines = 0, least = 0;  // of text; bytes at least
  std::istringstream header{std::string(content.substr(0, end))};
  for (std::string line; std::getline(header, line);) {
    std::istringstream words(line);
    std::string word, type;
    words >> word;
    if (word == "format") {
      words >> word;
      ascii = word == "ascii";
    } else if (word == "element") {
      elements = 0;
      words >> word >> elements;
      lines += elements;
    } else if (word == "property") {
      words >> type;
      if (type == "list") words >> type;  // of how many, and none at least
      least += elements * bytesOf(type);
    }
  }
  const std::string_view rest = content.substr(body + 1);
  if (ascii) {
    const auto held = static_cast<std::uint64_t>(std::count(rest.begin(), rest.end(), '\n')) +
                      (!rest.empty() && rest.back() != '\n' ? 1 : 0);
    if (held < lines)
      return "expected " + std::to_string(lines) + " lines after the header, as it says, found " +
             std::to_string(held) + ": the file ends early";
  } else if (rest.size() < least) {
    return "expected at least " + std::to_string(least) + " bytes after the header, as it says, found " +
           std::to_string(rest.size()) + ": the file ends early";
  }
  return {};
}

}  // namespace migiwa
