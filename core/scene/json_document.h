// JSON text into a document, with the faults of the text in plain words: broken JSON by line and column, and
// keys that an object has twice. Private to core/scene and core/io, the only folders that know JSON.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace migiwa {

/// Keeps the order in which keys were written.
using Json = nlohmann::ordered_json;

/// What is wrong at one place of a document.
struct DocumentFault {
  std::string pointer;  ///< JSON pointer; for broken JSON `line:column` instead
  std::string message;
};

// NOLINTNEXTLINE(bugprone-exception-escape): a move that the library declares noexcept is seen as throwing
struct JsonDocument {
  Json root;
  bool broken = false;                ///< not JSON at all: `faults` has the one reason, `root` means nothing
  std::vector<DocumentFault> faults;  ///< in the order of the text
};

JsonDocument parseJson(std::string_view text);

/// `pointer` with one more token, escaped as RFC 6901 asks.
std::string childPointer(std::string_view pointer, std::string_view key);
std::string childPointer(std::string_view pointer, std::size_t index);

/// What a value is, for "found ...": numbers and short texts themselves, else the kind with its size.
std::string describeJson(const Json& value);

/// A text in quotes, escaped, and shortened when it is long.
std::string quotedText(std::string_view text);

/// Indented text in which arrays of plain values stay on one line. Ends with a newline.
std::string prettyJson(const Json& value);

/// The whole file. Throws InputError when there is none, when it is a folder, too large or cannot be read.
/// `kind` says what was expected, such as "a scene file".
std::string readTextFile(const std::filesystem::path& file, std::string_view kind);

}  // namespace migiwa
