#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>

#include "core/base/files.h"
#include "core/scene/json.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"

namespace migiwa {

namespace {

std::string withUnit(std::string text, const FieldDoc& doc) {
  if (!doc.unit.empty() && doc.unit != "1") text += " (unit: " + std::string(doc.unit) + ")";
  return text;
}

std::string expectedNumber(std::string_view kind, const Range& range, const FieldDoc& doc) {
  if (range.min == range.max) return range.text();
  return withUnit(std::string(kind) + " " + range.text(), doc);
}

/// The known name that was probably meant, as a question to append; `otherwise` if none is near.
std::string didYouMean(std::string_view word, std::span<const std::string_view> names,
                       const std::string& otherwise) {
  std::string_view nearest = nearestName(word, names);
  const auto letters = static_cast<int>(std::max(word.size(), nearest.size()));
  if (nearest.empty() || 2 * editDistance(word, nearest) > letters) {
    // Far, unless it is the beginning of a longer name.
    const auto longer = std::find_if(names.begin(), names.end(),
                                     [&](std::string_view name) { return name.starts_with(word); });
    if (word.size() < 2 || longer == names.end()) return otherwise;
    nearest = *longer;
  }
  return "; did you mean \"" + std::string(nearest) + "\"?";
}

std::string child(const std::string& pointer, std::string_view key) {
  return key.empty() ? pointer : childPointer(pointer, key);
}

/// What to do about decimals with a comma: in a text instead of a number, or more entries than there are
/// numbers.
std::string decimalHint(const Json& found, std::string_view expected) {
  if (found.is_string() && expected.starts_with("a number")) {
    std::string text = found.get<std::string>();
    const std::size_t comma = text.find(',');
    if (comma == text.npos || text.find_first_not_of("0123456789,+-eE. ") != text.npos) return {};
    text[comma] = '.';
    return "; a number has no quotes, and a point before its decimals: " + text;
  }
  if (!found.is_array() || !expected.starts_with("an array of ")) return {};
  std::size_t wanted = 0;
  for (const char c : expected.substr(12)) {
    if (c < '0' || c > '9') break;
    wanted = 10 * wanted + static_cast<std::size_t>(c - '0');
  }
  const bool integers = std::all_of(found.begin(), found.end(), [](const Json& entry) {
    return entry.is_number_integer() || entry.is_number_unsigned();
  });
  return wanted > 0 && found.size() > wanted && integers ? "; decimals follow a point, and 0,2 is two numbers"
                                                         : std::string();
}

/// Reads the fields of one JSON object, and of the objects in it, into the structs that visit them. Every
/// fault is collected; a faulty value leaves the default in place. Unknown keys are faults.
class JsonReader final : public FieldVisitor {
 public:
  /// Reads `object` (which must be one), found at `pointer`, through `fields`, then looks for unknown keys.
  /// Positions become relative to `origin`.
  static void read(const Json& object, const std::string& pointer, const Vec3d& origin, FaultList& faults,
                   const Fields& fields) {
    JsonReader reader(object, pointer, origin, faults);
    fields(reader);
    reader.reportUnknownKeys();
  }

  void number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) override {
    const auto fits = [&](const Json& found) {
      return found.is_number() && std::isfinite(found.get<double>()) && range.contains(found.get<double>());
    };
    if (const Json* found = take(key, doc, expectedNumber("a number", range, doc), fits))
      value = found->get<double>();
  }

  void integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) override {
    const auto fits = [&](const Json& found) {
      const double read = found.is_number() ? found.get<double>() : 0.5;
      return std::abs(read) <= std::numeric_limits<int>::max() && std::floor(read) == read &&
             range.contains(read);
    };
    if (const Json* found = take(key, doc, expectedNumber("a whole number", range, doc), fits))
      value = static_cast<int>(found->get<double>());
  }

  void boolean(std::string_view key, bool& value, const FieldDoc& doc) override {
    if (const Json* found = take(key, doc, "true or false", std::mem_fn(&Json::is_boolean)))
      value = found->get<bool>();
  }

  void text(std::string_view key, std::string& value, const FieldDoc& doc) override {
    if (const Json* found = take(key, doc, "a text", std::mem_fn(&Json::is_string)))
      value = found->get<std::string>();
  }

  void file(std::string_view key, FileName& value, const FieldDoc& doc) override {
    text(key, value.written, doc);
    value.path.clear();
    value.identity = {};
    const bool given = object_.contains(key) && valid({key});
    if (given && value.empty()) wrong(key, "a file name", "\"\"");
    if (value.empty()) return;
    const std::filesystem::path folder = faults_.folder(childPointer(pointer_, key));
    value.path = folder / value.written;
    const std::vector<std::filesystem::path> files = filesOfShape(value.path);
    for (const std::filesystem::path& file : files) faults_.noteFile(file);
    value.identity = identityOf(files);
    // An included scene may lie elsewhere: written again, the name has to hold from the scene itself.
    if (folder != faults_.sceneFolder() && std::filesystem::path(value.written).is_relative())
      value.written = value.path.lexically_proximate(faults_.sceneFolder()).generic_string();
  }

  void vector(std::string_view key, Vec3d& value, const FieldDoc& doc) override {
    numbers(key, doc, {value.data(), 3});
  }

  void place(std::string_view key, Vec3d& value, const FieldDoc& doc) override {
    if (numbers(key, doc, {value.data(), 3})) value -= origin_;
  }

  void coordinate(std::string_view key, double& value, int axis, const FieldDoc& doc) override {
    double read = value + origin_[axis];
    number(key, read, kCoordinateRange, doc);
    value = read - origin_[axis];
  }

  Vec3d origin() const override { return origin_; }

  void pair(std::string_view key, std::array<double, 2>& value, const FieldDoc& doc, bool* present) override {
    const bool read = numbers(key, doc, value);
    if (present != nullptr) *present = read;
  }

  void triples(std::string_view key, std::vector<std::array<double, 3>>& values,
               const FieldDoc& doc) override {
    const Json* const found = take(key, doc, "an array of arrays of 3 numbers", std::mem_fn(&Json::is_array));
    if (found == nullptr) return;
    std::vector<std::array<double, 3>> read;
    for (std::size_t k = 0; k < found->size(); ++k) {
      const Json& entry = (*found)[k];
      const bool valid = entry.is_array() && entry.size() == 3 &&
                         std::all_of(entry.begin(), entry.end(), [](const Json& number) {
                           return number.is_number() && std::isfinite(number.get<double>());
                         });
      if (valid) {
        read.push_back(entry.get<std::array<double, 3>>());
      } else {
        wrongEntry(key, k, "an array of 3 numbers", entry);
      }
    }
    if (valid({key})) values = std::move(read);
  }

  void choice(std::string_view key, int& index, std::span<const std::string_view> names,
              const FieldDoc& doc) override {
    const std::string expected = (names.size() == 1   ? ""
                                  : names.size() == 2 ? "either of "
                                                      : "one of ") +
                                 quotedList(names);
    const Json* const found = find(key, doc, expected);
    if (found == nullptr) return;
    if (!found->is_string()) return wrong(key, expected, describeJson(*found));
    const auto& word = found->get_ref<const std::string&>();
    const auto name = std::find(names.begin(), names.end(), word);
    if (name == names.end()) return wrong(key, expected, quotedText(word) + didYouMean(word, names, ""));
    index = static_cast<int>(name - names.begin());
  }

  void object(std::string_view key, const FieldDoc& doc, const Fields& fields, bool* present) override {
    if (present != nullptr) *present = object_.contains(key);
    const Json* const found = take(key, doc, "an object", std::mem_fn(&Json::is_object));
    if (found == nullptr) return;
    const std::size_t before = faults_.size();
    read(*found, childPointer(pointer_, key), origin_, faults_, fields);
    if (faults_.size() > before) faulty_.emplace(key);
  }

  void list(std::string_view key, std::size_t, const FieldDoc& doc, const Element& element) override {
    const Json* const found = take(key, doc, "an array of objects", std::mem_fn(&Json::is_array));
    if (found == nullptr) return;
    const std::size_t before = faults_.size();
    for (std::size_t k = 0; k < found->size(); ++k) {
      const Json& entry = (*found)[k];
      if (entry.is_object()) {
        read(entry, childPointer(childPointer(pointer_, key), k), origin_, faults_,
             [&](FieldVisitor& fields) { element(fields, k); });
      } else {
        wrongEntry(key, k, "an object", entry);
      }
    }
    if (faults_.size() > before) faulty_.emplace(key);
  }

  void variant(std::string_view key, int& index, std::span<const std::string_view> names, const FieldDoc& doc,
               const Variant& fields) override {
    index = -1;
    choice(key, index, names, doc);
    openEnded_ = openEnded_ || index < 0;
    if (index >= 0) fields(*this, index);
  }

  void fault(std::string_view key, std::string_view message) override {
    if (!valid({key})) return;
    faults_.add(child(pointer_, key), std::string(message));
    if (!key.empty()) faulty_.emplace(key);
  }

  void warning(std::string_view key, std::string_view message) override {
    faults_.warn(child(pointer_, key), message);
  }

  bool valid(std::initializer_list<std::string_view> keys) const override {
    return std::none_of(keys.begin(), keys.end(),
                        [&](std::string_view key) { return faulty_.contains(key); });
  }

  bool given(std::string_view key) const override {
    return key.starts_with('/') ? object_.contains(Json::json_pointer(std::string(key)))
                                : object_.contains(key);
  }

 private:
  JsonReader(const Json& object, const std::string& pointer, const Vec3d& origin, FaultList& faults)
      : object_(object), pointer_(pointer), origin_(origin), faults_(faults) {}

  /// The value of a key, or null when it is absent: then a fault that says `expected`, if the key is
  /// required.
  const Json* find(std::string_view key, const FieldDoc& doc, const std::string& expected) {
    known_.push_back(key);
    const auto found = object_.find(key);
    if (found != object_.end()) return &*found;
    if (doc.presence == Presence::required) wrong(key, expected, "nothing; the key is required");
    return nullptr;
  }

  /// The same, and a fault and null for a value that does not fit.
  template <class Fits>
  const Json* take(std::string_view key, const FieldDoc& doc, const std::string& expected, const Fits& fits) {
    const Json* const found = find(key, doc, expected);
    if (found == nullptr || fits(*found)) return found;
    wrong(key, expected, describeJson(*found) + decimalHint(*found, expected));
    return nullptr;
  }

  void wrong(std::string_view key, const std::string& expected, const std::string& found) {
    faults_.add(childPointer(pointer_, key), "expected " + expected + ", found " + found);
    faulty_.emplace(key);
  }

  void wrongEntry(std::string_view key, std::size_t index, const std::string& expected, const Json& found) {
    faults_.add(childPointer(childPointer(pointer_, key), index),
                "expected " + expected + ", found " + describeJson(found));
    faulty_.emplace(key);
  }

  /// Reads as many numbers as there is room for; nothing changes, and false, where one of them is wrong.
  bool numbers(std::string_view key, const FieldDoc& doc, std::span<double> values) {
    const std::string expected = withUnit("an array of " + std::to_string(values.size()) + " numbers", doc);
    const auto fits = [&](const Json& found) { return found.is_array() && found.size() == values.size(); };
    const Json* const found = take(key, doc, expected, fits);
    if (found == nullptr) return false;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const Json& entry = (*found)[k];
      if (!entry.is_number() || !kCoordinateRange.contains(entry.get<double>()))
        wrongEntry(key, k, expectedNumber("a number", kCoordinateRange, doc), entry);
    }
    if (!valid({key})) return false;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = (*found)[k].get<double>();
    return true;
  }

  void reportUnknownKeys() {
    if (openEnded_) return;
    for (const auto& item : object_.items()) {
      if (std::find(known_.begin(), known_.end(), item.key()) != known_.end()) continue;
      faults_.add(childPointer(pointer_, item.key()),
                  "expected a known key, found " + quotedText(item.key()) +
                      didYouMean(item.key(), known_, "; known here: " + quotedList(known_)));
    }
  }

  const Json& object_;
  const std::string& pointer_;
  const Vec3d& origin_;
  FaultList& faults_;
  std::vector<std::string_view> known_;
  std::set<std::string, std::less<>> faulty_;
  bool openEnded_ = false;  ///< the deciding key of a variant is wrong, so which keys belong here is unknown
};

constexpr std::string_view kSpacing = "/particle_spacing";

/// What takes the whole scene to see: too many steps, too many particles for this machine, or too far away
/// for a float's digits.
void checkWhole(const Scene& scene, FaultList& faults) {
  if (!faults.anyBelow("/duration") && !faults.anyBelow("/solver"))
    if (const auto fault = tooShortStep(scene.solver, scene.duration))
      faults.add("/solver/time_step", *fault);
  if (faults.anyBelow("/fluid") || faults.anyBelow("/emitters") || faults.anyBelow(kSpacing)) return;
  const double spacing = scene.particleSpacing;
  // With drains nobody knows how many of those that emitters give there are at once.
  const double counted = scene.drains.empty() ? scene.duration : 0;
  const auto count = [&](double other) { return particleCount(scene, other, counted); };
  if (const auto fault = tooManyParticles(count, spacing, availableMemory())) faults.add(kSpacing, *fault);

  Bounds fluid;
  for (const auto& source : scene.fluid) fluid.include(source->bounds());
  for (const Emitter& emitter : scene.emitters) fluid.include(emitter.bounds());
  if (fluid.empty()) return;
  const double farthest = std::max(fluid.min.cwiseAbs().maxCoeff(), fluid.max.cwiseAbs().maxCoeff());
  const double coarsest = farthest * double(std::numeric_limits<float>::epsilon());
  if (coarsest > spacing / 100) {
    std::ostringstream text;
    text << "expected at least " << 100 * coarsest << " m for fluid as far as " << farthest << " m from ";
    if (scene.origin.isZero(0)) {
      text << "the origin";
    } else {
      text << "[" << scene.origin.x() << ", " << scene.origin.y() << ", " << scene.origin.z()
           << "], where the scene is";
    }
    text << ": positions there are " << coarsest << " m apart, found " << spacing
         << " m; move the parts of the scene nearer together or use a larger spacing";
    faults.add(kSpacing, text.str());
  }
}

}  // namespace

Scene parseScene(std::string_view text, const std::filesystem::path& name,
                 const std::vector<Override>& overrides) {
  std::vector<std::filesystem::path> named;
  return parseScene(text, name, overrides, named);
}

Scene parseScene(std::string_view text, const std::filesystem::path& name,
                 const std::vector<Override>& overrides, std::vector<std::filesystem::path>& named) {
  named.clear();
  FaultList faults(name.string());
  Json root = resolveIncludes(text, name, faults);
  applyOverrides(overrides, root, faults);
  Scene scene;
  scene.file = name;
  scene.origin = originOf(root, faults);
  JsonReader::read(root, "", scene.origin, faults,
                   [&](FieldVisitor& fields) { describeScene(fields, scene); });
  named = faults.files();
  checkWhole(scene, faults);
  if (faults.empty()) checkPlaces(scene, root, faults);
  if (!faults.empty()) throw InputError(faults.faults());
  scene.warnings = faults.warnings();
  if (scene.name.empty()) scene.name = scene.stem();
  return scene;
}

Scene readScene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return parseScene(readTextFile(file, "a scene file"), file, overrides);
}

}  // namespace migiwa
