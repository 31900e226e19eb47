#include "core/scene/scene_edit.h"

#include <algorithm>
#include <charconv>

#include "core/scene/json_document.h"
#include "core/scene/json_writer.h"
#include "core/scene/overrides.h"
#include "core/scene/scene_identity.h"
#include "core/scene/scene_reader.h"
#include "core/scene/scene_writer.h"

namespace migiwa {

namespace {

/// Follows a JSON pointer through a text that is JSON.
class PointerScanner {
 public:
  PointerScanner(std::string_view text, const std::vector<std::string>& tokens)
      : text_(text), tokens_(tokens) {}

  /// Where the value begins, or its key, or as much of the way as there is.
  std::size_t find() {
    skipSpace();
    found_ = at_;
    descend(0);
    return found_;
  }

 private:
  bool ended() const { return at_ >= text_.size(); }
  char now() const { return ended() ? '\0' : text_[at_]; }
  void skipSpace() {
    while (!ended() && std::string_view(" \t\r\n").find(now()) != std::string_view::npos) ++at_;
  }

  /// At a text's opening quote; returns the text with its quotes.
  std::string_view takeText() {
    const std::size_t begin = at_++;
    while (!ended() && now() != '"') at_ += now() == '\\' ? 2U : 1U;
    at_ = std::min(at_ + 1, text_.size());
    return text_.substr(begin, at_ - begin);
  }

  void skipValue() {
    int open = 0;
    do {
      skipSpace();
      if (now() == '"') {
        takeText();
        continue;
      }
      if (now() == '{' || now() == '[') ++open;
      if (now() == '}' || now() == ']') --open;
      const bool plain = std::string_view("{}[],:").find(now()) == std::string_view::npos;
      ++at_;
      while (plain && !ended() && std::string_view("{}[],: \t\r\n").find(now()) == std::string_view::npos)
        ++at_;
    } while (open > 0 && !ended());
  }

  void descend(std::size_t depth) {
    if (depth == tokens_.size() || (now() != '{' && now() != '[')) return;
    const bool object = now() == '{';
    ++at_;
    for (std::size_t index = 0; !ended(); ++index) {
      skipSpace();
      if (now() == '}' || now() == ']') return;
      const std::size_t begin = at_;
      std::string token = std::to_string(index);
      if (object) {
        token = Json::parse(takeText(), nullptr, false).get<std::string>();
        skipSpace();
        ++at_;  // the colon
        skipSpace();
      }
      if (token == tokens_[depth]) {
        found_ = begin;
        return descend(depth + 1);
      }
      skipValue();
      skipSpace();
      if (now() == ',') ++at_;
    }
  }

  std::string_view text_;
  const std::vector<std::string>& tokens_;
  std::size_t at_ = 0, found_ = 0;
};

Json normalised(const Scene& scene) {
  return JsonWriter::write([&](FieldWriter& fields) { describeScene(fields, scene); });
}

/// The JSON Merge Patch that leads from one object to the other. A camera is written as a whole: where the
/// file has none, a part of one would not do.
Json difference(const Json& from, const Json& to) {
  Json patch = Json::object();
  for (const auto& item : to.items()) {
    const auto before = from.find(item.key());
    if (before == from.end()) {
      patch[item.key()] = item.value();
    } else if (before->is_object() && item.value().is_object() && item.key() != "camera") {
      Json inner = difference(*before, item.value());
      if (!inner.empty()) patch[item.key()] = std::move(inner);
    } else if (*before != item.value()) {
      patch[item.key()] = item.value();
    }
  }
  for (const auto& item : from.items())
    if (!to.contains(item.key())) patch[item.key()] = nullptr;
  return patch;
}

/// Puts a patch into a file's own object. A null stays where the file includes another: there it takes out
/// what that one has.
void patchInto(Json& object, const Json& patch, bool keepNull) {
  for (const auto& item : patch.items()) {
    if (item.value().is_null() && !keepNull) {
      object.erase(item.key());
    } else if (item.value().is_object()) {
      if (!object.contains(item.key()) || !object[item.key()].is_object())
        object[item.key()] = Json::object();
      patchInto(object[item.key()], item.value(), keepNull);
    } else {
      object[item.key()] = item.value();
    }
  }
}

}  // namespace

int lineOfFault(const Fault& fault, std::string_view text, const std::filesystem::path& file) {
  const std::string prefix = file.string() + ":";
  if (!fault.place.starts_with(prefix)) return 0;
  const std::string_view place = std::string_view(fault.place).substr(prefix.size());
  if (!place.starts_with('/')) {
    int line = 0;
    std::from_chars(place.data(), place.data() + place.size(), line);
    return line;
  }
  std::vector<std::string> tokens;
  if (place != "/") tokens = pointerTokens(place).value_or(tokens);
  const std::size_t offset = std::min(PointerScanner(text, tokens).find(), text.size());
  return 1 +
         static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
}

std::string sceneTextWith(std::string_view text, const std::filesystem::path& file, const Scene& scene) {
  const Json wanted = normalised(scene);
  const Json patch = difference(normalised(parseScene(text, file)), wanted);
  if (patch.empty()) return std::string(text);
  Json root = parseJson(text).root;
  patchInto(root, patch, root.contains("include"));
  std::string changed = prettyJson(root);
  // What "set" puts in goes over everything else: then only the whole scene says what is meant.
  try {
    if (normalised(parseScene(changed, file)) == wanted) return changed;
  } catch (const InputError&) {
  }
  return prettyJson(wanted);
}

std::string startOf(Scene scene) {
  const Scene plain;
  scene.boundary = plain.boundary;
  scene.effects.clear();
  scene.solver = plain.solver;
  return sceneIdentity(scene).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace migiwa
