#include <algorithm>
#include <charconv>

#include "core/base/hash.h"
#include "core/scene/json.h"
#include "core/scene/scene_file.h"

namespace migiwa {

Json JsonWriter::write(const Fields& fields, const FileEntry& fileEntry) {
  JsonWriter writer;
  writer.fileEntry_ = fileEntry;
  fields(writer);
  return std::move(writer.object_);
}

void JsonWriter::put(std::string_view key, Json value) {
  object_[std::string(key)] = std::move(value);
}

void JsonWriter::number(std::string_view key, const double& value, const Range&, const FieldDoc&) {
  put(key, value);
}

void JsonWriter::integer(std::string_view key, const int& value, const Range&, const FieldDoc&) {
  put(key, value);
}

void JsonWriter::boolean(std::string_view key, const bool& value, const FieldDoc&) {
  put(key, value);
}

void JsonWriter::text(std::string_view key, const std::string& value, const FieldDoc&) {
  if (!value.empty()) put(key, value);
}

void JsonWriter::file(std::string_view key, const FileName& value, const FieldDoc&) {
  if (!value.empty()) put(key, fileEntry_ ? fileEntry_(value) : Json(value.written));
}

void JsonWriter::vector(std::string_view key, const Vec3d& value, const FieldDoc&) {
  put(key, Json::array({value.x(), value.y(), value.z()}));
}

void JsonWriter::triples(std::string_view key, const std::vector<std::array<double, 3>>& values,
                         const FieldDoc&) {
  Json rows = Json::array();
  for (const std::array<double, 3>& row : values) rows.push_back(Json::array({row[0], row[1], row[2]}));
  put(key, std::move(rows));
}

void JsonWriter::pair(std::string_view key, const std::array<double, 2>& value, const FieldDoc&,
                      const bool* present) {
  if (present == nullptr || *present) put(key, value);
}

void JsonWriter::choice(std::string_view key, const int& index, std::span<const std::string_view> names,
                        const FieldDoc&) {
  put(key, std::string(names[static_cast<std::size_t>(index)]));
}

void JsonWriter::object(std::string_view key, const FieldDoc&, const Fields& fields, const bool* present) {
  if (present == nullptr || *present) put(key, write(fields, fileEntry_));
}

void JsonWriter::list(std::string_view key, std::size_t size, const FieldDoc&, const Element& element) {
  Json entries = Json::array();
  for (std::size_t k = 0; k < size; ++k)
    entries.push_back(write([&](FieldWriter& fields) { element(fields, k); }, fileEntry_));
  put(key, std::move(entries));
}

void JsonWriter::variant(std::string_view key, const int& index, std::span<const std::string_view> names,
                         const FieldDoc& doc, const Variant& fields) {
  choice(key, index, names, doc);
  fields(*this, index);
}

std::string writeScene(const Scene& scene) {
  return prettyJson(JsonWriter::write([&](FieldWriter& fields) { describeScene(fields, scene); }));
}

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

namespace {

Json fileIdentity(const FileName& name) {
  return {{"name", name.written},
          {"bytes", name.identity.bytes},
          {"checksum", hexDigits(name.identity.checksum)}};
}

std::string shown(const Json* value) {
  return value == nullptr ? "none" : describeJson(*value);
}

void compare(const Json* expected, const Json* found, const std::string& pointer,
             std::vector<DocumentFault>& faults) {
  if (expected != nullptr && found != nullptr) {
    if (*expected == *found) return;
    if (expected->is_object() && found->is_object()) {
      for (const auto& [key, value] : expected->items())
        compare(&value, found->contains(key) ? &(*found)[key] : nullptr, childPointer(pointer, key), faults);
      for (const auto& [key, value] : found->items())
        if (!expected->contains(key)) compare(nullptr, &value, childPointer(pointer, key), faults);
      return;
    }
    // Of vectors, all is said by showing them whole.
    const bool lists = expected->is_array() && found->is_array() && expected->size() == found->size() &&
                       !expected->empty() && expected->front().is_structured();
    if (lists) {
      for (std::size_t k = 0; k < expected->size(); ++k)
        compare(&(*expected)[k], &(*found)[k], childPointer(pointer, k), faults);
      return;
    }
    if (expected->is_array() && found->is_array() && expected->size() == found->size()) {
      faults.push_back({pointer, "expected " + expected->dump() + ", found " + found->dump()});
      return;
    }
  }
  faults.push_back({pointer, "expected " + shown(expected) + ", found " + shown(found)});
}

}  // namespace

Json sceneIdentity(const Scene& scene) {
  Json identity = JsonWriter::write([&](FieldWriter& fields) { describeScene(fields, scene); }, fileIdentity);
  for (const char* key : {"name", "description", "duration", "view"}) identity.erase(key);
  return identity;
}

std::vector<DocumentFault> identityFaults(const Json& expected, const Json& found) {
  std::vector<DocumentFault> faults;
  compare(&expected, &found, "", faults);
  return faults;
}

}  // namespace migiwa
