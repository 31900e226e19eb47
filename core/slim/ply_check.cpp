#include "core/slim/ply_check.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

#include "core/slim/ply_header.h"

namespace migiwa {

namespace {

/// Text, line by line.
class Lines {
 public:
  Lines(std::string_view text, std::size_t before) : rest_(text), number_(before) {}

  /// Goes to the next line that holds something; false when there is none.
  bool next() {
    do {
      if (rest_.empty()) return false;
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      skipSpace();
    } while (line_.empty());
    return true;
  }
  /// The next word of the line; empty at its end.
  std::string_view word() {
    const std::size_t end = std::min(line_.find_first_of(kSpace), line_.size());
    const std::string_view result = line_.substr(0, end);
    line_.remove_prefix(end);
    skipSpace();
    return result;
  }
  std::string place() const { return "line " + std::to_string(number_); }

 private:
  static constexpr std::string_view kSpace = " \t\r\v\f";
  void skipSpace() { line_.remove_prefix(std::min(line_.find_first_not_of(kSpace), line_.size())); }

  std::string_view rest_, line_;
  std::size_t number_;
};

template <class Number>
bool isNumber(std::string_view word, Number& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

/// What is wrong with the line of one element; empty where nothing is. Strictly: what assimp takes for the
/// end of a word or of a line, and what for the next number, is its own.
std::string textFault(const PlyElement& element, Lines& lines) {
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
  Lines lines(header.body, header.lines);
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

}  // namespace migiwa
