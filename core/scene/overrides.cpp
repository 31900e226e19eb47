#include "core/scene/overrides.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace migiwa {

namespace {

std::optional<std::size_t> arrayIndex(const std::string& token) {
  std::size_t index = 0;
  const auto [end, code] = std::from_chars(token.data(), token.data() + token.size(), index);
  if (code != std::errc() || end != token.data() + token.size()) return std::nullopt;
  if (token.size() > 1 && token.front() == '0') return std::nullopt;
  return index;
}

/// A JSON value, else a bare word. What begins like an object, an array or a quoted text has to be one:
/// nothing if not.
std::optional<Json> parseValue(const Override& override, FaultList& faults) {
  JsonDocument document = parseJson(override.value);
  const std::size_t first = override.value.find_first_not_of(" \t\r\n");
  const bool structured = first != std::string::npos &&
                          std::string_view("{[\"").find(override.value[first]) != std::string_view::npos;
  if (document.broken && !structured) return override.value;
  for (const DocumentFault& fault : document.faults) {
    if (document.broken) {
      faults.addAt({"", override.pointer}, fault.message + " (at " + fault.pointer + " of the value)");
    } else {
      faults.addAt({"", override.pointer + fault.pointer}, fault.message);
    }
  }
  if (document.broken) return std::nullopt;
  return std::move(document.root);
}

}  // namespace

std::optional<std::vector<std::string>> pointerTokens(std::string_view pointer) {
  if (!pointer.starts_with('/')) return std::nullopt;
  std::vector<std::string> result;
  for (std::size_t k = 0; k < pointer.size(); ++k) {
    if (pointer[k] == '/') {
      result.emplace_back();
    } else if (pointer[k] != '~') {
      result.back() += pointer[k];
    } else if (k + 1 < pointer.size() && (pointer[k + 1] == '0' || pointer[k + 1] == '1')) {
      result.back() += pointer[++k] == '0' ? '~' : '/';
    } else {
      return std::nullopt;
    }
  }
  return result;
}

Override Override::parse(std::string_view argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string_view::npos || !argument.starts_with('/'))
    throw InputError("--set", "expected /json/pointer=VALUE, found " + quotedText(argument));
  const std::string_view pointer = argument.substr(0, equals);
  if (!pointerTokens(pointer).has_value())
    throw InputError("--set", "expected ~0 for ~ and ~1 for / in a pointer, found " + quotedText(pointer));
  return {std::string(pointer), std::string(argument.substr(equals + 1))};
}

void setValue(Json& root, const std::string& pointer, Json value, const Origin& origin, FaultList& faults) {
  const std::vector<std::string> tokens = pointerTokens(pointer).value_or(std::vector<std::string>());
  Json* place = &root;
  std::string reached;
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    const std::string& token = tokens[k];
    const bool last = k + 1 == tokens.size();
    const std::string& shown = reached.empty() ? "/" : reached;
    if (place->is_object()) {
      if (last && value.is_null()) {
        place->erase(token);
        faults.origins().add(childPointer(reached, token), origin);
        return;
      }
      // A new member is an object until the next token or the value says otherwise.
      if (!place->contains(token)) {
        (*place)[token] = Json::object();
        const std::string made = childPointer(reached, token);
        faults.origins().add(
            made, origin.file.empty() ? Origin{"", made} : Origin{origin.file, origin.pointer, true});
      }
      place = &(*place)[token];
      reached = childPointer(reached, token);
    } else if (place->is_array()) {
      std::optional<std::size_t> index = arrayIndex(token);
      if (last && token == "-") {
        index = place->size();
        place->push_back(nullptr);
      }
      if (!index || *index >= place->size()) {
        faults.addAt(origin, "expected the index of one of " + std::to_string(place->size()) +
                                 " entries at " + shown + ", found " + quotedText(token));
        return;
      }
      place = &(*place)[*index];
      reached = childPointer(reached, *index);
    } else {
      faults.addAt(origin, "expected an object or an array at " + shown + ", found " + describeJson(*place));
      return;
    }
  }
  *place = std::move(value);
  faults.origins().add(reached, origin);
}

void applyOverrides(const std::vector<Override>& overrides, Json& root, FaultList& faults) {
  for (const Override& override : overrides)
    if (std::optional<Json> value = parseValue(override, faults))
      setValue(root, override.pointer, *std::move(value), {"", override.pointer}, faults);
}

}  // namespace migiwa
