#include <algorithm>
#include <cctype>
#include <cstdint>
#include <optional>
#include <sstream>

#include "core/slim/shape_import.h"
#include "core/slim/text_lines.h"

namespace migiwa {

namespace {

/// What is wrong with the line of one element; empty where nothing is. Strictly: what assimp takes for the
/// end of a word or of a line, and what for the next number, is its own.
std::string textFault(const PlyElement& element, TextLines& lines) {
  for (const PlyProperty& property : element.properties) {
    std::uint64_t values = 1;
    if (property.listCount.bytes > 0) {
      const std::string_view word = lines.word();
      if (!isNumber(word, values))
        return "expected how many numbers follow in " + lines.place() + ", found \"" + std::string(word) +
               '"';
    }
    for (std::uint64_t k = 0; k < values; ++k) {
      const std::string_view word = lines.word();
      double ignored = 0;
      if (word.empty())
        return "expected " + std::to_string(values) + " numbers in " + lines.place() + ", found " +
               std::to_string(k);
      if (!isNumber(word, ignored))
        return "expected a number in " + lines.place() + ", found \"" + std::string(word) + '"';
    }
  }
  if (const std::string_view word = lines.word(); !word.empty())
    return "expected the end of " + lines.place() + ", found \"" + std::string(word) + '"';
  return {};
}

std::string textFault(const PlyHeader& header) {
  TextLines lines(header.body, header.lines);
  std::uint64_t expected = 0, found = 0;
  for (const PlyElement& element : header.elements) expected += element.count;
  for (const PlyElement& element : header.elements)
    for (std::uint64_t k = 0; k < element.count; ++k, ++found) {
      if (!lines.next())
        return "expected " + std::to_string(expected) + " lines after the header, as it says, found " +
               std::to_string(found) + ": the file ends early";
      if (std::string fault = textFault(element, lines); !fault.empty()) return fault;
    }
  return {};
}

/// How many numbers a list holds; none where that is below zero, or the file has ended.
std::optional<std::uint64_t> listCount(std::string_view& rest, const PlyType& type,
                                       PlyHeader::Format format) {
  if (rest.size() < type.bytes) return std::nullopt;
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < type.bytes; ++k) {
    const std::size_t at = format == PlyHeader::Format::bigEndian ? k : type.bytes - 1 - k;
    value = value << 8U | static_cast<unsigned char>(rest[at]);
  }
  rest.remove_prefix(type.bytes);
  if (type.negative && value >> (8 * type.bytes - 1) != 0) return std::nullopt;
  return value;
}

std::string binaryFault(const PlyHeader& header) {
  std::string_view rest = header.body;
  for (const PlyElement& element : header.elements)
    for (std::uint64_t k = 0; k < element.count; ++k)
      for (const PlyProperty& property : element.properties) {
        std::optional<std::uint64_t> values = 1;
        if (property.listCount.bytes > 0) values = listCount(rest, property.listCount, header.format);
        if (!values || rest.size() / property.type.bytes < *values)
          return "expected all numbers of each element after the header, as it says, found that the file "
                 "ends early";
        rest.remove_prefix(*values * property.type.bytes);
      }
  return {};
}

}  // namespace

std::string plyFault(std::string_view content) {
  PlyHeader header;
  if (std::string fault = readPlyHeader(content, header); !fault.empty()) return fault;
  return header.format == PlyHeader::Format::ascii ? textFault(header) : binaryFault(header);
}

namespace {

PlyType typeOf(const std::string& name) {
  if (name == "char" || name == "int8") return {1, true, true};
  if (name == "uchar" || name == "uint8") return {1, true, false};
  if (name == "short" || name == "int16") return {2, true, true};
  if (name == "ushort" || name == "uint16") return {2, true, false};
  if (name == "int" || name == "int32") return {4, true, true};
  if (name == "uint" || name == "uint32") return {4, true, false};
  if (name == "float" || name == "float32") return {4, false, true};
  if (name == "double" || name == "float64") return {8, false, true};
  return {};
}

std::vector<std::string> wordsOf(std::string_view line) {
  std::istringstream in{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// Whether a line begins with a word and holds words and spaces only. What else there may be, assimp takes
/// for the end of a line, or for part of a word.
bool isPlain(std::string_view line) {
  return !line.starts_with(' ') && !line.starts_with('\t') &&
         std::none_of(line.begin(), line.end(),
                      [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\t'; });
}

bool takeFormat(const std::vector<std::string>& words, PlyHeader& header) {
  using Format = PlyHeader::Format;
  if (words.size() != 3) return false;
  header.format = words[1] == "ascii"                  ? Format::ascii
                  : words[1] == "binary_little_endian" ? Format::littleEndian
                                                       : Format::bigEndian;
  return header.format != Format::bigEndian || words[1] == "binary_big_endian";
}

/// Elements without properties have no place in the file, unless there are none of them.
bool lastIsWhole(const PlyHeader& header) {
  return header.elements.empty() || header.elements.back().count == 0 ||
         !header.elements.back().properties.empty();
}

/// `most`: elements that a file of this size can hold.
bool takeElement(const std::vector<std::string>& words, std::uint64_t most, PlyHeader& header) {
  // Digits at the front of a name are the count to assimp.
  if (words.size() != 3 || std::isalpha(static_cast<unsigned char>(words[1].front())) == 0 ||
      !lastIsWhole(header))
    return false;
  PlyElement element;
  element.name = words[1];
  std::istringstream number(words[2]);
  if (!(number >> element.count) || !number.eof() || element.count > most) return false;
  header.elements.push_back(element);
  return true;
}

bool takeProperty(const std::vector<std::string>& words, PlyHeader& header) {
  if (words.size() < 3 || header.elements.empty()) return false;
  const bool list = words[1] == "list";
  if (words.size() != (list ? 5 : 3)) return false;
  PlyProperty property{words.back(), typeOf(words[list ? 3 : 1]), list ? typeOf(words[2]) : PlyType()};
  if (property.type.bytes == 0 || (list && !property.listCount.whole)) return false;
  header.elements.back().properties.push_back(property);
  return true;
}

/// Takes a line of the header over; false when it is none.
bool take(const std::vector<std::string>& words, std::uint64_t most, PlyHeader& header) {
  if (words.empty()) return false;
  const std::string& kind = words.front();
  if (kind == "comment" || kind == "obj_info") return true;
  if (kind == "format") return takeFormat(words, header);
  if (kind == "element") return takeElement(words, most, header);
  return kind == "property" && takeProperty(words, header);
}

}  // namespace

std::string readPlyHeader(std::string_view content, PlyHeader& header) {
  if (!content.starts_with("ply")) return "expected a PLY file, found one that does not begin with \"ply\"";
  header.body = content;
  while (true) {
    const std::size_t end = header.body.find('\n');
    if (end == header.body.npos) return "expected a PLY file, found one that ends within its header";
    std::string_view line = header.body.substr(0, end);
    header.body.remove_prefix(end + 1);
    if (++header.lines == 1) continue;
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::vector<std::string> words = isPlain(line) ? wordsOf(line) : std::vector<std::string>();
    if (words == std::vector<std::string>{"end_header"} && lastIsWhole(header)) return {};
    if (!take(words, content.size(), header))
      return "expected the header of a PLY file, found something else in its line " +
             std::to_string(header.lines);
  }
}

}  // namespace migiwa
