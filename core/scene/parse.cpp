// JSON texts: read, with what is wrong with them in words of our own, and searched by pointer.
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <deque>
#include <set>

#include "core/scene/json.h"

namespace migiwa {

namespace {

constexpr std::size_t kLongestToken = 60;
constexpr std::size_t kDeepest = 64;
constexpr std::string_view kSpace = " \t\r\n";

bool isOneOf(char c, std::string_view characters) {
  return characters.find(c) != std::string_view::npos;
}

bool isDigit(char c) {
  return isOneOf(c, "0123456789");
}

bool isAscii(char c) {
  return static_cast<unsigned char>(c) < 0x80;
}

bool beginsNumber(char c) {
  return c == '-' || isDigit(c);
}

/// A sign, a word, a number or a text in quotes, each as far as it may go on; any other character by itself.
struct Token {
  std::size_t begin = 0, end = 0;

  std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
};

/// Goes to where a number ends, or to where it lacks a digit.
std::size_t numberEnd(std::string_view text, std::size_t at) {
  const auto now = [&] { return at < text.size() ? text[at] : '\0'; };
  const auto passDigits = [&] {
    const std::size_t from = at;
    while (isDigit(now())) ++at;
    return at > from;
  };
  if (now() == '-') ++at;
  if (now() == '0') {
    ++at;
  } else if (!passDigits()) {
    return at;
  }
  if (now() == '.') {
    ++at;
    if (!passDigits()) return at;
  }
  if (now() == 'e' || now() == 'E') {
    ++at;
    if (now() == '+' || now() == '-') ++at;
    passDigits();
  }
  return at;
}

std::size_t tokenEnd(std::string_view text, std::size_t begin) {
  if (begin == text.size()) return begin;
  if (beginsNumber(text[begin])) return numberEnd(text, begin);
  std::size_t at = begin;
  if (text[begin] == '"') {
    for (++at; at < text.size() && text[at] != '"'; ++at)
      if (text[at] == '\\') ++at;
    return std::min(at + 1, text.size());
  }
  while (at < text.size() && std::isalpha(static_cast<unsigned char>(text[at])) != 0) ++at;
  return std::max(at, begin + 1);
}

/// The first token from `at` on; an empty one at the end of the text.
Token tokenFrom(std::string_view text, std::size_t at) {
  const std::size_t begin = std::min(text.find_first_not_of(kSpace, at), text.size());
  return {begin, tokenEnd(text, begin)};
}

Token firstToken(std::string_view text) {
  return tokenFrom(text, text.starts_with("\xEF\xBB\xBF") ? 3 : 0);
}

/// The sign that a token is, or the first character of what else it is; 0 at the end of the text.
char signOf(std::string_view text, const Token& token) {
  return token.begin < text.size() ? text[token.begin] : '\0';
}

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
  for (Token token = firstToken(text); token.begin < text.size(); token = tokenFrom(text, token.end)) {
    const char sign = signOf(text, token);
    if (isOneOf(sign, "[{") && open++ == depth) return token.begin;
    if (isOneOf(sign, "]}")) --open;
  }
  return text.size();
}

/// The number that four hexadecimal digits at `at` write; nothing if they are not there.
std::optional<unsigned> codeUnit(std::string_view text, std::size_t at) {
  const std::string_view digits = text.substr(std::min(at, text.size()), 4);
  unsigned unit = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), unit, 16);
  if (error != std::errc() || end != digits.data() + 4) return std::nullopt;
  return unit;
}

/// What is wrong with a `\u` whose u is at `at`, which moves to the last character of it, or nothing.
std::string_view codeUnitFault(std::string_view text, std::size_t& at) {
  const std::optional<unsigned> unit = codeUnit(text, at + 1);
  if (!unit) return "'\\u' must be followed by 4 hex digits";
  at += 4;
  if (*unit >= 0xDC00 && *unit <= 0xDFFF) return "surrogate U+DC00..U+DFFF must follow U+D800..U+DBFF";
  if (*unit < 0xD800 || *unit > 0xDBFF) return {};
  const std::optional<unsigned> low =
      text.substr(at + 1).starts_with("\\u") ? codeUnit(text, at + 3) : std::nullopt;
  if (low.value_or(0) < 0xDC00 || *low > 0xDFFF)
    return "surrogate U+D800..U+DBFF must be followed by U+DC00..U+DFFF";
  at += 6;
  return {};
}

std::string controlCharacterFault(char c) {
  constexpr std::array<std::string_view, 32> kNames{"NUL", "SOH", "STX", "ETX", "EOT", "ENQ", "ACK", "BEL",
                                                    "BS",  "HT",  "LF",  "VT",  "FF",  "CR",  "SO",  "SI",
                                                    "DLE", "DC1", "DC2", "DC3", "DC4", "NAK", "SYN", "ETB",
                                                    "CAN", "EM",  "SUB", "ESC", "FS",  "GS",  "RS",  "US"};
  const auto code = static_cast<unsigned char>(c);
  const std::string number = {'0', '0', code < 16 ? '0' : '1', "0123456789ABCDEF"[code % 16]};
  const std::size_t brief = std::string_view("\b\t\n\f\r").find(c);
  return "control character U+" + number + " (" + std::string(kNames[code]) + ") must be escaped to \\u" +
         number + (brief < 5 ? std::string(" or \\") + "btnfr"[brief] : "");
}

constexpr std::string_view kSaveAsUtf8 =
    "; the file seems to be in Latin-1 or another code of one byte a letter: save it as UTF-8";

/// Whether the text is in 16 or 32 bits a letter without a mark that says so: letters of JSON come with
/// zeros.
bool isWide(std::string_view text) {
  return text.size() >= 2 && (text[0] == '\0') != (text[1] == '\0');
}

/// What is wrong with a text in quotes, from its opening quote to the last byte that the parser took; `ended`
/// when it wanted more than there are.
std::string textFault(std::string_view text, bool ended) {
  const auto invalid = [](std::string_view why) { return "an invalid text (" + std::string(why) + ")"; };
  const std::string_view before = text.substr(0, std::max<std::size_t>(text.size(), 2) - 1);
  const bool cutsCharacter = !isAscii(before.back()) && !Json::accept(std::string(before) + '"');
  if (!ended && cutsCharacter) return invalid("ill-formed UTF-8 byte").append(kSaveAsUtf8);
  for (std::size_t k = 1; k < text.size(); ++k) {
    if (text[k] == '\n') return "a text that does not end on its line";
    if (static_cast<unsigned char>(text[k]) < 0x20) return invalid(controlCharacterFault(text[k]));
    if (text[k] != '\\') continue;
    const char escaped = ++k < text.size() ? text[k] : '\0';
    if (!isOneOf(escaped, "\"\\/bfnrtu")) return invalid("forbidden character after backslash");
    const std::string_view fault = escaped == 'u' ? codeUnitFault(text, k) : std::string_view();
    if (!fault.empty()) return invalid(fault);
  }
  return ended ? "a text that never ends" : invalid("ill-formed UTF-8 byte").append(kSaveAsUtf8);
}

/// What a number lacks that ends too early.
std::string_view numberFault(std::string_view number) {
  if (number == "-") return "expected digit after '-'";
  if (number.back() == '.') return "expected digit after '.'";
  if (isOneOf(number.back(), "eE")) return "expected '+', '-', or digit after exponent";
  return "expected digit after exponent sign";
}

/// What is common elsewhere and not JSON, at the beginning of `rest`. `before`: the last character of the
/// token before.
std::string_view hint(std::string_view rest, char before) {
  if (rest.starts_with("\xFF\xFE") || rest.starts_with("\xFE\xFF")) return "; save the file as UTF-8";
  if (before == ',' && isOneOf(rest.front(), "}]")) return "; no comma follows the last entry";
  if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with('#'))
    return "; JSON has no comments, a description can say more";
  if (rest.starts_with('\'') || rest.starts_with("\xE2\x80\x9C") || rest.starts_with("\xE2\x80\x98"))
    return "; JSON takes plain double quotes only";
  if (rest.starts_with("NaN") || rest.starts_with("Infinity")) return "; JSON has finite numbers only";
  if (rest.starts_with("True") || rest.starts_with("False")) return "; JSON writes true and false";
  if (rest.starts_with('+') || rest.starts_with('.')) return "; a number begins with a digit or -";
  return "";
}

/// The word or sign at the beginning of `rest`, for people.
std::string shownToken(std::string_view rest) {
  std::size_t size = rest.find_first_of(" \t\r\n,:{}[]\"");
  if (rest.front() == '"') size = rest.find('"', 1) == std::string_view::npos ? 1 : rest.find('"', 1) + 1;
  size = std::max<std::size_t>(1, std::min({size, rest.size(), kLongestToken}));
  std::string token(rest.substr(0, size));
  if (rest.front() != '"') token.insert(0, 1, '\'').push_back('\'');
  return token;
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
    level.afterKey = true;
    level.repeated = !level.keys.insert(value).second;
    if (level.repeated)
      document_.faults.push_back(
          {childPointer(level.pointer, value), "expected each key once, found it again"});
    level.key = std::move(value);
    return true;
  }

  /// Only the position is taken from the parser: the words of its exceptions are its own affair.
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception&) override {
    if (isWide(text_))
      return refuse(0, "expected a text in UTF-8, found one in UTF-16 or UTF-32; save the file as UTF-8");
    // The token that the parser could not take is the first that is not JSON by itself, or the one that ends
    // where the parser stopped.
    char before = '\0';
    Token token = firstToken(text_);
    while (token.end < position && isJson(token)) {
      before = text_[token.end - 1];
      token = tokenFrom(text_, token.end);
    }
    // The parser takes a zero for the end, too.
    if (signOf(text_, token) == '\0') token.begin = text_.size();
    return refuse(token.begin, "expected " + syntaxFault(token, position, before));
  }

 private:
  struct Level {
    Json* value;
    std::string pointer;
    std::string key;
    std::set<std::string> keys;
    bool repeated = false;
    bool afterKey = false;  ///< the key's value is still to come
  };

  bool refuse(std::size_t offset, std::string message) {
    document_.broken = true;
    document_.faults = {{lineAndColumn(text_, offset), std::move(message)}};
    return false;
  }

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
    level.afterKey = false;
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
    if (levels_.size() == kDeepest)
      return refuse(offsetOfDepth(text_, kDeepest), "expected at most " + std::to_string(kDeepest) +
                                                        " arrays and objects in each other, found more");
    std::string pointer;
    if (!levels_.empty()) {
      const Level& level = levels_.back();
      pointer = level.value->is_array() ? childPointer(level.pointer, level.value->size())
                                        : childPointer(level.pointer, level.key);
    }
    // What an array or object inside a repeated value is called does not matter: the repetition is a fault
    // already.
    Json* const value = place(std::move(container));
    levels_.push_back({value, std::move(pointer), {}, {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  bool isJson(const Token& token) const {
    const char sign = signOf(text_, token);
    return sign != '\0' && (isOneOf(sign, "{}[],:") || Json::accept(token.of(text_)));
  }

  /// What would have been right behind the token that ends with `before`.
  std::string_view expectedBehind(char before) const {
    if (levels_.empty()) return before == '\0' ? "a value" : "the end of the text";
    const Level& level = levels_.back();
    const bool array = level.value->is_array();
    if (before == ':' || (array && isOneOf(before, "[,"))) return "a value";
    if (!array && isOneOf(before, "{,")) return "a key in double quotes";
    if (level.afterKey) return "':' after the key";
    return array ? "',' or ']' after the value" : "',' or '}' after the value";
  }

  /// "..., found ..." of the token that cannot be behind the one that ends with `before`.
  std::string syntaxFault(const Token& token, std::size_t position, char before) const {
    const std::string expected(expectedBehind(before));
    const char sign = signOf(text_, token);
    const std::string_view rest = text_.substr(token.begin);
    if (rest.empty())
      return expected + (before == '\0' ? ", found an empty text" : ", found the end of the text");
    if (sign == '"' && !isJson(token))
      return expected + ", found " +
             textFault(rest.substr(0, position - token.begin), position > text_.size());
    const std::string_view number = beginsNumber(sign) ? token.of(text_) : std::string_view();
    if (!number.empty() && !isDigit(number.back()))
      return expected + ", found an invalid number (" + std::string(numberFault(number)) + ")";
    if (!number.empty() && expected == "a value")
      return "a number that is not beyond 1e308, found " + shownToken(rest);
    const std::size_t at = token.begin;
    const bool decimalComma = !number.empty() && before == ',' && at > 1 && text_[at - 1] == ',' &&
                              isDigit(text_[at - 2]) && isDigit(sign);
    return expected + ", found " + shownToken(rest) +
           (decimalComma ? "; decimals follow a point, not a comma: " + numberBefore(at - 1) + "." +
                               std::string(number)
                         : std::string(hint(rest, before)));
  }

  /// The digits, and a minus, that end at `end`.
  std::string numberBefore(std::size_t end) const {
    std::size_t begin = end;
    while (begin > 0 && beginsNumber(text_[begin - 1])) --begin;
    return std::string(text_.substr(begin, end - begin));
  }

  std::string_view text_;
  JsonDocument& document_;
  std::vector<Level> levels_;
  std::deque<Json> repeated_;  ///< values of repeated keys, read and dropped
};

}  // namespace

JsonDocument parseJson(std::string_view text) {
  JsonDocument document;
  DocumentBuilder builder(text, document);
  Json::sax_parse(text.begin(), text.end(), &builder);
  return document;
}

namespace {

/// Calls `visit` with the pointer of each value of a text that is JSON, and the byte at which it begins, or
/// its key.
template <class Visit>
void eachValue(std::string_view text, const Visit& visit) {
  struct Level {
    std::string pointer;
    bool object;
    std::size_t index = 0;
  };
  std::vector<Level> levels;
  Token token = firstToken(text);
  const auto next = [&] { token = tokenFrom(text, token.end); };
  for (; token.begin < text.size(); next()) {
    const char sign = signOf(text, token);
    if (isOneOf(sign, "}]")) {
      if (levels.empty()) return;
      levels.pop_back();
      continue;
    }
    if (sign == ',') {
      if (!levels.empty()) ++levels.back().index;
      continue;
    }
    std::string pointer;
    const std::size_t begin = token.begin;
    if (!levels.empty() && !levels.back().object) {
      pointer = childPointer(levels.back().pointer, levels.back().index);
    } else if (!levels.empty()) {
      const Json key = Json::parse(token.of(text), nullptr, false);
      pointer = childPointer(levels.back().pointer, key.is_string() ? key.get<std::string>() : "");
      next();  // the colon
      next();
    }
    visit(pointer, begin);
    const char value = signOf(text, token);
    if (isOneOf(value, "{[")) levels.push_back({std::move(pointer), value == '{'});
  }
}

}  // namespace

std::vector<std::size_t> offsetsOf(std::string_view text, std::span<const std::string> pointers) {
  const auto above = [](const std::string& pointer) { return pointer.substr(0, pointer.rfind('/')); };
  std::unordered_map<std::string, std::size_t> offsets{{"", firstToken(text).begin}};
  for (std::string pointer : pointers)
    for (; !pointer.empty(); pointer = above(pointer)) offsets.emplace(pointer, std::string::npos);
  eachValue(text, [&](const std::string& pointer, std::size_t offset) {
    const auto wanted = offsets.find(pointer);
    if (wanted != offsets.end() && wanted->second == std::string::npos) wanted->second = offset;
  });
  std::vector<std::size_t> found;
  for (std::string pointer : pointers) {
    while (offsets.at(pointer) == std::string::npos) pointer = above(pointer);
    found.push_back(offsets.at(pointer));
  }
  return found;
}

}  // namespace migiwa
