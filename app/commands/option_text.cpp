#include "app/commands/option_text.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "core/base/error.h"

namespace migiwa {
namespace {

constexpr double kLatestTime = 1e6;  // (s), as long as a scene's duration can be
constexpr int kSmallestSide = 64, kLargestSide = 8192;

/// Parts at commas that stand outside brackets and quotes.
std::vector<std::string> partsAtCommas(std::string_view text) {
  std::vector<std::string> parts{""};
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && (i == 0 || text[i - 1] != '\\')) quoted = !quoted;
    if (!quoted && (c == '[' || c == '{')) ++depth;
    if (!quoted && (c == ']' || c == '}')) --depth;
    if (c == ',' && depth == 0 && !quoted) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

template <class Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::vector<double> parseTimes(const std::string& text, std::string_view option) {
  const auto parse = [&](const std::string& part) {
    const std::optional<double> time = number<double>(part);
    if (time && *time >= 0 && *time <= kLatestTime) return *time;
    throw InputError(std::string(option),
                     "expected numbers in [0, 1e+06] (unit: s) with commas between them, found \"" + part +
                         "\" in \"" + text + "\"");
  };
  std::vector<double> times;
  for (const std::string& part : partsAtCommas(text)) times.push_back(parse(part));
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::array<int, 2> parseSize(const std::string& text, std::string_view option) {
  const std::size_t cross = std::min(text.find('x'), text.size());
  const int width = number<int>(std::string_view(text).substr(0, cross)).value_or(0);
  const int height = number<int>(std::string_view(text).substr(std::min(cross + 1, text.size()))).value_or(0);
  for (const int side : {width, height}) {
    if (side < kSmallestSide || side > kLargestSide) {
      throw InputError(std::string(option),
                       "expected WIDTHxHEIGHT in pixels, each in [64, 8192], found \"" + text + "\"");
    }
  }
  return {width, height};
}

std::vector<Override> parseVariants(const std::string& text, std::string_view option) {
  try {
    const Override all = Override::parse(text);
    std::vector<Override> variants;
    for (const std::string& value : partsAtCommas(all.value)) variants.push_back({all.pointer, value});
    return variants;
  } catch (const InputError& error) {
    throw InputError(std::string(option), error.faults().front().message);
  }
}

}  // namespace migiwa
