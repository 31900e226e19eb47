#include "core/scene/json.h"

#include <algorithm>
#include <cctype>
#include <deque>
#include <fstream>
#include <set>

#include "core/base/messages.h"

namespace migiwa {

namespace {

constexpr std::size_t kLongestQuote = 60;
constexpr std::size_t kDeepest = 64;

/// Counts lines and columns from 1; a column is one character, however many bytes it has.
std::string lineAndColumn(std::string_view text, std::size_t offset) {
  std::size_t line = 1;
  std::size_t column = 1;
  for (const char c : text.substr(0, offset)) {
    if (c == '\n') {
      ++line;
      column = 1;
    } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
      ++column;
    }
  }
  return std::to_string(line) + ":" + std::to_string(column);
}

/// Where the text first opens an array or object inside `depth` others.
std::size_t offsetOfDepth(std::string_view text, std::size_t depth) {
  std::size_t open = 0;
  bool inText = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (inText && text[k] == '\\') {
      ++k;
    } else if (text[k] == '"') {
      inText = !inText;
    } else if (!inText && (text[k] == '[' || text[k] == '{')) {
      if (open++ == depth) return k;
    } else if (!inText && (text[k] == ']' || text[k] == '}')) {
      --open;
    }
  }
  return text.size();
}

std::string_view between(std::string_view text, std::string_view from, std::string_view to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string_view::npos) return {};
  text.remove_prefix(begin + from.size());
  return text.substr(0, text.find(to));
}

std::string after(std::string_view text, std::string_view sign) {
  return std::string(text.substr(text.find(sign) + sign.size()));
}

/// What the parser wanted, from the part of the text it was in.
std::string expectedHere(std::string_view context) {
  if (context == "object key") return "a key in double quotes";
  if (context == "object separator") return "':' after the key";
  if (context == "object") return "',' or '}' after the value";
  if (context == "array") return "',' or ']' after the value";
  return "a value";
}

/// Builds the document and notes keys that come twice. The first one stays.
class DocumentBuilder final : public nlohmann::json_sax<Json> {
 public:
  DocumentBuilder(std::string_view text, JsonDocument& document) : text_(text), document_(document) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    Level& level = levels_.back();
    level.repeated = !level.keys.insert(value).second;
    if (level.repeated)
      document_.faults.push_back(
          {childPointer(level.pointer, value), "expected each key once, found it again"});
    level.key = std::move(value);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& error) override {
    document_.broken = true;
    document_.faults.clear();
    const std::string_view what = error.what();
    const bool atEnd = what.find("unexpected end of input") != std::string_view::npos;
    const std::size_t offset =
        atEnd ? text_.size() : tokenBegin(what, token, std::min(text_.size(), position));
    document_.faults.push_back({lineAndColumn(text_, offset), message(what, offset, atEnd)});
    return false;
  }

 private:
  struct Level {
    Json* value;
    std::string pointer;
    std::string key;
    std::set<std::string> keys;
    bool repeated = false;
  };

  template <class Value>
  bool add(Value&& value) {
    place(Json(std::forward<Value>(value)));
    return true;
  }

  Json* place(Json value) {
    if (levels_.empty()) {
      document_.root = std::move(value);
      return &document_.root;
    }
    Level& level = levels_.back();
    if (level.value->is_array()) {
      level.value->push_back(std::move(value));
      return &level.value->back();
    }
    if (level.repeated) {
      return &repeated_.emplace_back(std::move(value));
    }
    // Straight to the end: the set of keys has shown that it is not there yet.
    auto& members = level.value->get_ref<Json::object_t&>();
    members.push_back({level.key, std::move(value)});
    return &members.back().second;
  }

  bool open(Json container) {
    if (levels_.size() == kDeepest) {
      document_.broken = true;
      document_.faults = {
          {lineAndColumn(text_, offsetOfDepth(text_, kDeepest)),
           "expected at most " + std::to_string(kDeepest) + " arrays and objects in each other, found more"}};
      return false;
    }
    std::string pointer;
    if (!levels_.empty()) {
      const Level& level = levels_.back();
      pointer = level.value->is_array() ? childPointer(level.pointer, level.value->size())
                                        : childPointer(level.pointer, level.key);
    }
    // What an array or object inside a repeated value is called does not matter: the repetition is a fault
    // already.
    Json* const value = place(std::move(container));
    levels_.push_back({value, std::move(pointer), {}, {}, false});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  /// Where the token that ends at `end` begins. The parser knows that of texts and numbers only.
  std::size_t tokenBegin(std::string_view what, const std::string& token, std::size_t end) const {
    const std::string_view unexpected = between(what, "unexpected ", " literal");
    if (unexpected == "true" || unexpected == "false" || unexpected == "null") return end - unexpected.size();
    if (unexpected.starts_with('\'')) return end - 1;  // a sign
    if (what.find("invalid literal") != std::string_view::npos) {
      std::size_t begin = end - 1;
      while (begin > 0 && std::isalpha(static_cast<unsigned char>(text_[begin - 1])) != 0) --begin;
      return begin;
    }
    // Control characters of the token are written as <U+XXXX>.
    std::size_t size = 0;
    for (std::size_t k = 0; k < token.size(); ++k, ++size)
      if (token.compare(k, 3, "<U+") == 0 && k + 7 < token.size() && token[k + 7] == '>') k += 7;
    return end - std::min(size, end);
  }

  std::string message(std::string_view what, std::size_t offset, bool atEnd) const {
    const std::string_view lexer = between(what, " - ", "; last read");
    if (what.find("number overflow") != std::string_view::npos)
      return "expected a number that is not beyond 1e308, found " + tokenAt(offset);
    std::string expected = "expected " + expectedHere(between(what, "while parsing ", " - "));
    if (text_.find_first_not_of(" \t\r\n") == std::string_view::npos)
      return expected + ", found an empty text";
    if (atEnd) return expected + ", found the end of the text";
    if (text_.find_first_not_of(" \t\r\n") < offset &&
        what.find("expected end of input") != std::string_view::npos)
      return "expected the end of the text, found " + tokenAt(offset);
    if (lexer.starts_with("invalid string: missing closing quote"))
      return expected + ", found a text that never ends";
    if (lexer.starts_with("invalid string: control character U+000A"))
      return expected + ", found a text that does not end on its line";
    if (lexer.starts_with("invalid string: "))
      return expected + ", found an invalid text (" + after(lexer, ": ") + ")";
    if (lexer.starts_with("invalid number; "))
      return expected + ", found an invalid number (" + after(lexer, "; ") + ")";
    return expected + ", found " + tokenAt(offset) + hint(offset);
  }

  /// What is common elsewhere and not JSON.
  std::string hint(std::size_t offset) const {
    const std::string_view rest = text_.substr(offset);
    const std::size_t before = text_.find_last_not_of(" \t\r\n", offset == 0 ? 0 : offset - 1);
    const bool afterComma = offset > 0 && before != std::string_view::npos && text_[before] == ',';
    if (rest.starts_with("\xFF\xFE") || rest.starts_with("\xFE\xFF")) return "; save the file as UTF-8";
    if (afterComma && (rest.front() == '}' || rest.front() == ']'))
      return "; no comma follows the last entry";
    if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with('#'))
      return "; JSON has no comments, a description can say more";
    if (rest.starts_with('\'') || rest.starts_with("\xE2\x80\x9C") || rest.starts_with("\xE2\x80\x98"))
      return "; JSON takes plain double quotes only";
    if (rest.starts_with("NaN") || rest.starts_with("Infinity")) return "; JSON has finite numbers only";
    if (rest.starts_with("True") || rest.starts_with("False")) return "; JSON writes true and false";
    if (rest.starts_with('+') || rest.starts_with('.')) return "; a number begins with a digit or -";
    return "";
  }

  /// The word or sign that begins at `offset`.
  std::string tokenAt(std::size_t offset) const {
    std::string_view rest = text_.substr(offset);
    if (rest.empty()) return "the end of the text";
    std::size_t size = rest.find_first_of(" \t\r\n,:{}[]\"");
    if (rest.front() == '"') size = rest.find('"', 1) == std::string_view::npos ? 1 : rest.find('"', 1) + 1;
    size = std::max<std::size_t>(1, std::min({size, rest.size(), kLongestQuote}));
    std::string token(rest.substr(0, size));
    if (rest.front() != '"') token.insert(0, 1, '\'').push_back('\'');
    return token;
  }

  std::string_view text_;
  JsonDocument& document_;
  std::vector<Level> levels_;
  std::deque<Json> repeated_;  ///< values of repeated keys, read and dropped
};

std::string compact(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void writePretty(const Json& value, const std::string& indent, std::string& out) {
  const std::string inner = indent + "  ";
  const bool flat = value.is_array() && std::none_of(value.begin(), value.end(), [](const Json& entry) {
                      return entry.is_structured() && !entry.empty();
                    });
  if (!value.is_structured() || value.empty()) {
    out += compact(value);
  } else if (flat) {
    out += "[";
    for (std::size_t k = 0; k < value.size(); ++k) out += (k > 0 ? ", " : "") + compact(value[k]);
    out += "]";
  } else {
    out += value.is_array() ? "[" : "{";
    const char* separator = "\n";
    for (const auto& item : value.items()) {
      out += separator + inner + (value.is_array() ? "" : compact(Json(item.key())) + ": ");
      writePretty(item.value(), inner, out);
      separator = ",\n";
    }
    out += "\n" + indent + (value.is_array() ? "]" : "}");
  }
}

}  // namespace

JsonDocument parseJson(std::string_view text) {
  JsonDocument document;
  DocumentBuilder builder(text, document);
  Json::sax_parse(text.begin(), text.end(), &builder);
  return document;
}

std::string childPointer(std::string_view pointer, std::string_view key) {
  std::string result(pointer);
  result += '/';
  for (const char c : key) {
    if (c == '~') {
      result += "~0";
    } else if (c == '/') {
      result += "~1";
    } else {
      result += c;
    }
  }
  return result;
}

std::string childPointer(std::string_view pointer, std::size_t index) {
  return childPointer(pointer, std::to_string(index));
}

std::string describeJson(const Json& value) {
  switch (value.type()) {
    case Json::value_t::object:
      return "an object";
    case Json::value_t::array:
      if (value.empty()) return "an empty array";
      return value.size() == 1 ? "an array of 1 entry"
                               : "an array of " + std::to_string(value.size()) + " entries";
    case Json::value_t::string:
      return quotedText(value.get_ref<const std::string&>());
    default:
      return value.dump();
  }
}

std::string quotedText(std::string_view text) {
  std::size_t size = std::min(text.size(), kLongestQuote);
  while (size < text.size() && size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  const std::string shown(text.substr(0, size));
  return Json(shown).dump(-1, ' ', false, Json::error_handler_t::replace) + (size < text.size() ? "..." : "");
}

std::string prettyJson(const Json& value) {
  std::string text;
  writePretty(value, "", text);
  return text + "\n";
}

}  // namespace migiwa
