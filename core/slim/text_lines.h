// Files of numbers in text, line by line and word by word.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>

namespace migiwa {

/// Text, line by line. Words are views into it.
class TextLines {
 public:
  static constexpr std::string_view kSpace = " \t\r\v\f";

  /// `before`: lines of the file before the text. `space`: characters between words.
  explicit TextLines(std::string_view text, std::size_t before = 0, std::string_view space = kSpace)
      : rest_(text), number_(before), space_(space) {}

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
    const std::size_t end = std::min(line_.find_first_of(space_), line_.size());
    const std::string_view result = line_.substr(0, end);
    line_.remove_prefix(end);
    skipSpace();
    return result;
  }
  std::string place() const { return "line " + std::to_string(number_); }

 private:
  void skipSpace() { line_.remove_prefix(std::min(line_.find_first_not_of(space_), line_.size())); }

  std::string_view rest_, line_;
  std::size_t number_;
  std::string_view space_;
};

/// Whether a word is a number and nothing else; `value` then is that number.
template <class Number>
bool isNumber(std::string_view word, Number& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace migiwa
