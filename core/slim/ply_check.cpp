#include "core/slim/ply_check.h"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <vector>

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

struct Header {
  bool ascii = false;
  std::uint64_t elements = 0;  ///< of the kind whose properties follow
  std::uint64_t lines = 0;     ///< of text after it
  std::uint64_t least = 0;     ///< bytes after it
  bool properties = true;      ///< of the kind that was named last
};

std::vector<std::string> wordsOf(std::string_view line) {
  std::istringstream in{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// Takes a line of the header over; false when it is none. `most`: elements that a file of this size can
/// hold.
bool take(const std::vector<std::string>& words, std::uint64_t most, Header& header) {
  if (words.empty()) return false;
  const std::string& kind = words.front();
  if (kind == "comment" || kind == "obj_info") return true;
  if (kind == "format") {
    if (words.size() != 3) return false;
    header.ascii = words[1] == "ascii";
    return header.ascii || words[1] == "binary_little_endian" || words[1] == "binary_big_endian";
  }
  if (kind == "element") {
    if (words.size() != 3 || !header.properties) return false;
    std::istringstream number(words[2]);
    if (!(number >> header.elements) || !number.eof() || header.elements > most) return false;
    header.lines += header.elements;
    header.properties = header.elements == 0;
    return true;
  }
  if (kind != "property" || words.size() < 3) return false;
  const bool list = words[1] == "list";
  if (words.size() != (list ? 5 : 3)) return false;
  if (bytesOf(words[list ? 2 : 1]) == 0 || (list && bytesOf(words[3]) == 0)) return false;
  header.least += header.elements * bytesOf(words[list ? 2 : 1]);
  header.properties = true;
  return true;
}

}  // namespace

std::string plyFault(std::string_view content) {
  if (!content.starts_with("ply")) return "expected a PLY file, found one that does not begin with \"ply\"";
  Header header;
  std::string_view rest = content;
  for (std::size_t number = 1;; ++number) {
    const std::size_t end = rest.find('\n');
    if (end == rest.npos) return "expected a PLY file, found one that ends within its header";
    const std::vector<std::string> words = wordsOf(rest.substr(0, end));
    rest.remove_prefix(end + 1);
    if (number == 1) continue;
    if (words == std::vector<std::string>{"end_header"} && header.properties) break;
    if (!take(words, content.size(), header))
      return "expected the header of a PLY file, found something else in its line " + std::to_string(number);
  }

  if (header.ascii) {
    const auto held = static_cast<std::uint64_t>(std::count(rest.begin(), rest.end(), '\n')) +
                      (!rest.empty() && rest.back() != '\n' ? 1 : 0);
    if (held < header.lines)
      return "expected " + std::to_string(header.lines) + " lines after the header, as it says, found " +
             std::to_string(held) + ": the file ends early";
  } else if (rest.size() < header.least) {
    return "expected at least " + std::to_string(header.least) +
           " bytes after the header, as it says, found " + std::to_string(rest.size()) +
           ": the file ends early";
  }
  return {};
}

}  // namespace migiwa
