#include <algorithm>
#include <charconv>

#include "core/base/hash.h"
#include "core/scene/json.h"
#include "core/scene/scene_file.h"

namespace migiwa {

namespace {

/// The coordinate that is read as `relative` to `origin`: of those that are, one with few digits. That is the
/// one that was written, but for digits that were lost in the difference.
double absolute(double relative, double origin) {
  if (origin == 0) return relative;
  const double sum = relative + origin;
  for (int digits = 1; digits <= 17; ++digits) {
    std::array<char, 32> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), sum, std::chars_format::general, digits);
    double rounded = sum;
    std::from_chars(text.data(), end.ptr, rounded);
    if (rounded - origin == relative) return rounded;
  }
  return sum;
}

/// Writes what structs visit into a JSON object: every key, with the value in force. An empty text is left
/// out, it says nothing. Positions are relative to `origin`, and written as they are in the file.
class JsonWriter final : public FieldWriter {
 public:
  /// What stands for a file that a scene names.
  using FileEntry = std::function<Json(const FileName&)>;

  static Json write(const Fields& fields, const Vec3d& origin, const FileEntry& fileEntry) {
    JsonWriter writer(origin, fileEntry);
    fields(writer);
    return std::move(writer.object_);
  }

  void number(std::string_view key, const double& value, const Range&, const FieldDoc&) override {
    put(key, value);
  }
  void integer(std::string_view key, const int& value, const Range&, const FieldDoc&) override {
    put(key, value);
  }
  void boolean(std::string_view key, const bool& value, const FieldDoc&) override { put(key, value); }
  void text(std::string_view key, const std::string& value, const FieldDoc&) override {
    if (!value.empty()) put(key, value);
  }
  void file(std::string_view key, const FileName& value, const FieldDoc&) override {
    if (!value.empty()) put(key, fileEntry_(value));
  }
  void vector(std::string_view key, const Vec3d& value, const FieldDoc&) override {
    put(key, Json::array({value.x(), value.y(), value.z()}));
  }
  void place(std::string_view key, const Vec3d& value, const FieldDoc& doc) override {
    vector(key,
           {absolute(value.x(), origin_.x()), absolute(value.y(), origin_.y()),
            absolute(value.z(), origin_.z())},
           doc);
  }
  void coordinate(std::string_view key, const double& value, int axis, const FieldDoc&) override {
    put(key, absolute(value, origin_[axis]));
  }
  Vec3d origin() const override { return origin_; }
  void triples(std::string_view key, const std::vector<std::array<double, 3>>& values,
               const FieldDoc&) override {
    put(key, values);
  }
  void pair(std::string_view key, const std::array<double, 2>& value, const FieldDoc&,
            const bool* present) override {
    if (present == nullptr || *present) put(key, value);
  }
  void choice(std::string_view key, const int& index, std::span<const std::string_view> names,
              const FieldDoc&) override {
    put(key, names[static_cast<std::size_t>(index)]);
  }
  void object(std::string_view key, const FieldDoc&, const Fields& fields, const bool* present) override {
    if (present == nullptr || *present) put(key, write(fields, origin_, fileEntry_));
  }
  void list(std::string_view key, std::size_t size, const FieldDoc&, const Element& element) override {
    Json entries = Json::array();
    for (std::size_t k = 0; k < size; ++k)
      entries.push_back(write([&](FieldWriter& fields) { element(fields, k); }, origin_, fileEntry_));
    put(key, std::move(entries));
  }
  void variant(std::string_view key, const int& index, std::span<const std::string_view> names,
               const FieldDoc& doc, const Variant& fields) override {
    choice(key, index, names, doc);
    fields(*this, index);
  }

 private:
  JsonWriter(const Vec3d& origin, const FileEntry& fileEntry) : origin_(origin), fileEntry_(fileEntry) {}

  void put(std::string_view key, Json value) { object_[key] = std::move(value); }

  Json object_ = Json::object();
  const Vec3d& origin_;
  const FileEntry& fileEntry_;
};

Json written(const Scene& scene, const JsonWriter::FileEntry& fileEntry) {
  return JsonWriter::write([&](FieldWriter& fields) { describeScene(fields, scene); }, scene.origin,
                           fileEntry);
}

Json normalised(const Scene& scene) {
  return written(scene, [](const FileName& name) { return Json(name.written); });
}

Json fileIdentity(const FileName& name) {
  return {{"name", name.written},
          {"bytes", name.identity.bytes},
          {"checksum", hexDigits(name.identity.checksum)}};
}

/// The pointers at which the scenes `a` and `b` differ, in the order of their keys, each once: of the places
/// that the library's JSON Patch names, or the outermost one above that `whole` asks to be seen as one.
template <class Whole>
std::vector<Json::json_pointer> differences(const Json& a, const Json& b, const Whole& whole) {
  std::vector<Json::json_pointer> places;
  for (const Json& change : Json::diff(a, b)) {
    Json::json_pointer place(change["path"].get_ref<const std::string&>());
    for (Json::json_pointer above = place; !above.empty();) {
      above.pop_back();
      if (whole(above)) place = above;
    }
    if (places.empty() || places.back() != place) places.push_back(std::move(place));
  }
  return places;
}

}  // namespace

std::string writeScene(const Scene& scene) {
  return prettyJson(normalised(scene));
}

std::vector<std::filesystem::path> filesNamedBy(const Scene& scene) {
  std::vector<std::filesystem::path> files;
  written(scene, [&](const FileName& name) {
    for (std::filesystem::path& file : filesOfShape(name.path)) files.push_back(std::move(file));
    return Json();
  });
  return files;
}

std::vector<int> linesOfFaults(std::span<const Fault> faults, std::string_view text,
                               const std::filesystem::path& file) {
  const std::string prefix = file.string() + ":";
  std::vector<int> lines(faults.size(), 0);
  std::vector<std::string> pointers;
  std::vector<std::size_t> owners;
  for (std::size_t k = 0; k < faults.size(); ++k) {
    if (!faults[k].place.starts_with(prefix)) continue;
    const std::string place = faults[k].place.substr(prefix.size());
    if (place.starts_with('/')) {
      pointers.push_back(place == "/" || !parsePointer(place) ? "" : place);
      owners.push_back(k);
    } else {
      std::from_chars(place.data(), place.data() + place.size(), lines[k]);
    }
  }
  if (pointers.empty()) return lines;
  std::vector<std::size_t> ends;
  for (std::size_t at = text.find('\n'); at != std::string_view::npos; at = text.find('\n', at + 1))
    ends.push_back(at);
  const std::vector<std::size_t> offsets = offsetsOf(text, pointers);
  for (std::size_t k = 0; k < offsets.size(); ++k)
    lines[owners[k]] =
        1 + static_cast<int>(std::lower_bound(ends.begin(), ends.end(), offsets[k]) - ends.begin());
  return lines;
}

std::string sceneTextWith(std::string_view text, const std::filesystem::path& file, const Scene& scene) {
  const Json wanted = normalised(scene), read = normalised(parseScene(text, file));
  if (read == wanted) return std::string(text);
  Json root = parseJson(text).root;
  // Lists are written as a whole, and so is a camera: where the file has none, a part of one would not do.
  const auto whole = [&](const Json::json_pointer& place) {
    return read.at(place).is_array() || (!place.empty() && place.back() == "camera");
  };
  for (const Json::json_pointer& place : differences(read, wanted, whole)) {
    if (wanted.contains(place)) {
      root[place].merge_patch(wanted.at(place));
    } else if (root.contains(kIncludeKey)) {
      root[place] = nullptr;  // takes out what the included file has
    } else if (root.contains(place)) {
      root[place.parent_pointer()].erase(place.back());
    }
  }
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
  return compactJson(sceneIdentity(scene));
}

namespace {

/// As options of --set; what goes is said by `gone`.
template <class Whole>
std::vector<std::string> optionsBetween(const Json& before, const Json& after, const char* gone,
                                        const Whole& whole) {
  std::vector<std::string> options;
  for (const Json::json_pointer& place : differences(before, after, whole)) {
    const bool there = after.contains(place);
    const bool word = there && after.at(place).is_string();
    options.push_back(place.to_string() + "=" +
                      (!there ? gone
                       : word ? after.at(place).get<std::string>()
                              : compactJson(after.at(place))));
  }
  return options;
}

}  // namespace

std::vector<std::string> changesBetween(const Scene& from, const Scene& to) {
  const Json before = sceneIdentity(from), after = sceneIdentity(to);
  return optionsBetween(before, after, "none",
                        [&](const Json::json_pointer& above) { return before.at(above).is_array(); });
}

std::vector<std::string> viewChangesBetween(const Scene& from, const Scene& to) {
  const auto viewOf = [](const Scene& scene) {
    return Json{{"view", written(scene, fileIdentity).at("view")}};
  };
  const Json before = viewOf(from);
  // The file may have none of these, and then a part of one would not do.
  return optionsBetween(before, viewOf(to), "null", [&](const Json::json_pointer& above) {
    return before.at(above).is_array() ||
           (!above.empty() && (above.back() == "camera" || above.back() == "clip"));
  });
}

Json sceneIdentity(const Scene& scene) {
  Json identity = written(scene, fileIdentity);
  for (const char* key : {"name", "description", "duration", "view"}) identity.erase(key);
  return identity;
}

std::vector<DocumentFault> identityFaults(const Json& expected, const Json& found) {
  // Of vectors, all is said by showing them whole; lists of objects are looked into.
  const auto sameSize = [&](const Json::json_pointer& place) {
    return expected.at(place).is_array() && found.at(place).is_array() &&
           expected.at(place).size() == found.at(place).size();
  };
  const auto whole = [&](const Json::json_pointer& place) {
    const Json& value = expected.at(place);
    return value.is_array() && !(sameSize(place) && !value.empty() && value.front().is_structured());
  };
  std::vector<DocumentFault> faults;
  for (const Json::json_pointer& place : differences(expected, found, whole)) {
    const bool both = expected.contains(place) && found.contains(place);
    const auto shown = [&](const Json& side) {
      if (!side.contains(place)) return std::string("none");
      return both && sameSize(place) ? compactJson(side.at(place)) : describeJson(side.at(place));
    };
    faults.push_back({place.to_string(), "expected " + shown(expected) + ", found " + shown(found)});
  }
  return faults;
}

}  // namespace migiwa
