#include "core/scene/json.h"

#include <algorithm>

namespace migiwa {

namespace {

constexpr std::size_t kLongestQuote = 60;

void writePretty(const Json& value, const std::string& indent, std::string& out) {
  const std::string inner = indent + "  ";
  const bool flat = value.is_array() && std::none_of(value.begin(), value.end(), [](const Json& entry) {
                      return entry.is_structured() && !entry.empty();
                    });
  if (!value.is_structured() || value.empty()) {
    out += compactJson(value);
  } else if (flat) {
    out += "[";
    for (std::size_t k = 0; k < value.size(); ++k) out += (k > 0 ? ", " : "") + compactJson(value[k]);
    out += "]";
  } else {
    out += value.is_array() ? "[" : "{";
    const char* separator = "\n";
    for (const auto& item : value.items()) {
      out += separator + inner + (value.is_array() ? "" : compactJson(Json(item.key())) + ": ");
      writePretty(item.value(), inner, out);
      separator = ",\n";
    }
    out += "\n" + indent + (value.is_array() ? "]" : "}");
  }
}

/// Whether `pointer` is `ancestor` or lies below it.
bool isBelow(std::string_view pointer, std::string_view ancestor) {
  return pointer.starts_with(ancestor) &&
         (pointer.size() == ancestor.size() || pointer[ancestor.size()] == '/');
}

}  // namespace

Json readJson(std::string_view text) {
  return Json::parse(text);
}

std::string compactJson(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string childPointer(std::string_view pointer, std::string_view key) {
  return std::string(pointer) + (Json::json_pointer() / std::string(key)).to_string();
}

std::string childPointer(std::string_view pointer, std::size_t index) {
  return childPointer(pointer, std::to_string(index));
}

std::optional<Json::json_pointer> parsePointer(std::string_view text) {
  if (!text.starts_with('/')) return std::nullopt;
  try {
    return Json::json_pointer(std::string(text));
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::vector<std::string> tokensOf(Json::json_pointer pointer) {
  std::vector<std::string> tokens;
  for (; !pointer.empty(); pointer.pop_back()) tokens.insert(tokens.begin(), pointer.back());
  return tokens;
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
      return compactJson(value);
  }
}

std::string quotedText(std::string_view text) {
  std::size_t size = std::min(text.size(), kLongestQuote);
  while (size < text.size() && size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  const std::string shown(text.substr(0, size));
  return compactJson(shown) + (size < text.size() ? "..." : "");
}

std::string prettyJson(const Json& value) {
  std::string text;
  writePretty(value, "", text);
  return text + "\n";
}

void FaultList::add(std::string_view pointer, std::string message) {
  const Origin origin = originOf(pointer);
  // Under "set" the pointer is a key, with its slashes escaped: the plain one says more.
  if (!origin.file.empty() && origin.pointer != pointer) message += " (" + std::string(pointer) + ")";
  addAt(origin, std::move(message));
  pointers_.emplace_back(pointer);
}

void FaultList::addAt(const Origin& origin, std::string message) {
  faults_.push_back({origin.text(), std::move(message)});
}

void FaultList::warn(std::string_view pointer, std::string_view message) {
  warnings_.push_back(std::string(pointer) + ": " + std::string(message));
}

bool FaultList::anyBelow(std::string_view pointer) const {
  return std::any_of(pointers_.begin(), pointers_.end(),
                     [&](const std::string& found) { return isBelow(found, pointer); });
}

std::string Origin::text() const {
  const std::string shown = pointer.empty() ? "/" : pointer;
  return file.empty() ? "--set " + shown : file + ":" + shown;
}

FaultList::FaultList(std::string file) : file_(std::move(file)) {
  parts_.push_back({"", {file_, ""}});
}

void FaultList::addOrigin(std::string pointer, Origin origin) {
  parts_.push_back({std::move(pointer), std::move(origin)});
}

Origin FaultList::originOf(std::string_view pointer) const {
  // The last one covers what lay below it.
  const auto part = std::find_if(parts_.rbegin(), parts_.rend(),
                                 [&](const Part& candidate) { return isBelow(pointer, candidate.pointer); });
  Origin origin = part->origin;
  if (!origin.whole) origin.pointer += pointer.substr(part->pointer.size());
  return origin;
}

std::filesystem::path FaultList::folder(std::string_view pointer) const {
  const std::string file = originOf(pointer).file;
  return file.empty() ? sceneFolder() : std::filesystem::path(file).parent_path();
}

std::filesystem::path FaultList::sceneFolder() const {
  return std::filesystem::path(file_).parent_path();
}

}  // namespace migiwa
