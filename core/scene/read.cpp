#include <algorithm>
#include <cmath>
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

}  // namespace

JsonReader::JsonReader(const Json& object, const std::string& pointer, FaultList& faults)
    : object_(object), pointer_(pointer), faults_(faults) {}

void JsonReader::read(const Json& object, const std::string& pointer, FaultList& faults,
                      const Fields& fields) {
  JsonReader reader(object, pointer, faults);
  fields(reader);
  reader.reportUnknownKeys();
}

const Json* JsonReader::find(std::string_view key, const FieldDoc& doc, const std::string& expected) {
  known_.push_back(key);
  const auto found = object_.find(std::string(key));
  if (found != object_.end()) return &*found;
  if (doc.presence == Presence::required) {
    wrong(key, expected, "nothing; the key is required");
  }
  return nullptr;
}

void JsonReader::wrong(std::string_view key, const std::string& expected, const std::string& found) {
  faults_.add(childPointer(pointer_, key), "expected " + expected + ", found " + found);
  faulty_.emplace(key);
}

void JsonReader::number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) {
  const std::string expected = expectedNumber("a number", range, doc);
  const Json* const found = find(key, doc, expected);
  if (found == nullptr) return;
  const double read = found->is_number() ? found->get<double>() : 0;
  if (found->is_number() && std::isfinite(read) && range.contains(read)) {
    value = read;
  } else {
    wrong(key, expected, describeJson(*found));
  }
}

void JsonReader::integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) {
  const std::string expected = expectedNumber("a whole number", range, doc);
  const Json* const found = find(key, doc, expected);
  if (found == nullptr) return;
  const double read = found->is_number() ? found->get<double>() : 0;
  const bool fits = std::abs(read) <= std::numeric_limits<int>::max() && std::floor(read) == read;
  if (found->is_number() && fits && range.contains(read)) {
    value = static_cast<int>(read);
  } else {
    wrong(key, expected, describeJson(*found));
  }
}

void JsonReader::boolean(std::string_view key, bool& value, const FieldDoc& doc) {
  const Json* const found = find(key, doc, "true or false");
  if (found == nullptr) return;
  if (found->is_boolean()) {
    value = found->get<bool>();
  } else {
    wrong(key, "true or false", describeJson(*found));
  }
}

void JsonReader::text(std::string_view key, std::string& value, const FieldDoc& doc) {
  const Json* const found = find(key, doc, "a text");
  if (found == nullptr) return;
  if (found->is_string()) {
    value = found->get<std::string>();
  } else {
    wrong(key, "a text", describeJson(*found));
  }
}

void JsonReader::file(std::string_view key, FileName& value, const FieldDoc& doc) {
  text(key, value.written, doc);
  value.path.clear();
  value.identity = {};
  const bool given = object_.contains(std::string(key)) && valid({key});
  if (given && value.empty()) wrong(key, "a file name", "\"\"");
  if (value.empty()) return;
  const Origins& origins = faults_.origins();
  const std::filesystem::path folder = origins.folder(childPointer(pointer_, key));
  value.path = folder / value.written;
  const std::vector<std::filesystem::path> files = filesOfShape(value.path);
  for (const std::filesystem::path& file : files) faults_.noteFile(file);
  value.identity = identityOf(files);
  // An included scene may lie elsewhere: written again, the name has to hold from the scene itself.
  if (folder != origins.sceneFolder() && std::filesystem::path(value.written).is_relative())
    value.written = value.path.lexically_proximate(origins.sceneFolder()).generic_string();
}

bool JsonReader::numbers(std::string_view key, const FieldDoc& doc, std::size_t size, double* values) {
  const std::string expected = withUnit("an array of " + std::to_string(size) + " numbers", doc);
  const Json* const found = find(key, doc, expected);
  if (found == nullptr) return false;
  if (!found->is_array() || found->size() != size) {
    wrong(key, expected, describeJson(*found));
    return false;
  }
  std::vector<double> read(size);
  const std::size_t before = faults_.size();
  for (std::size_t k = 0; k < size; ++k) {
    const Json& entry = (*found)[k];
    if (entry.is_number()) read[k] = entry.get<double>();
    if (entry.is_number() && kCoordinateRange.contains(read[k])) continue;
    faults_.add(
        childPointer(childPointer(pointer_, key), k),
        "expected " + expectedNumber("a number", kCoordinateRange, doc) + ", found " + describeJson(entry));
  }
  if (faults_.size() > before) {
    faulty_.emplace(key);
    return false;
  }
  std::copy(read.begin(), read.end(), values);
  return true;
}

void JsonReader::vector(std::string_view key, Vec3d& value, const FieldDoc& doc) {
  numbers(key, doc, 3, value.data());
}

void JsonReader::pair(std::string_view key, std::array<double, 2>& value, const FieldDoc& doc,
                      bool* present) {
  const bool read = numbers(key, doc, 2, value.data());
  if (present != nullptr) *present = read;
}

void JsonReader::triples(std::string_view key, std::vector<std::array<double, 3>>& values,
                         const FieldDoc& doc) {
  const std::string expected = "an array of arrays of 3 numbers";
  const Json* const found = find(key, doc, expected);
  if (found == nullptr) return;
  if (!found->is_array()) return wrong(key, expected, describeJson(*found));
  std::vector<std::array<double, 3>> read;
  for (std::size_t k = 0; k < found->size(); ++k) {
    const Json& entry = (*found)[k];
    const bool valid = entry.is_array() && entry.size() == 3 &&
                       std::all_of(entry.begin(), entry.end(), [](const Json& number) {
                         return number.is_number() && std::isfinite(number.get<double>());
                       });
    if (valid) {
      read.push_back({entry[0].get<double>(), entry[1].get<double>(), entry[2].get<double>()});
    } else {
      faults_.add(childPointer(childPointer(pointer_, key), k),
                  "expected an array of 3 numbers, found " + describeJson(entry));
      faulty_.emplace(key);
    }
  }
  if (!faulty_.contains(key)) values = std::move(read);
}

void JsonReader::choice(std::string_view key, int& index, std::span<const std::string_view> names,
                        const FieldDoc& doc) {
  const std::string expected = (names.size() == 1   ? ""
                                : names.size() == 2 ? "either of "
                                                    : "one of ") +
                               quotedList(names);
  const Json* const found = find(key, doc, expected);
  if (found == nullptr) return;
  const auto name = found->is_string()
                        ? std::find(names.begin(), names.end(), found->get_ref<const std::string&>())
                        : names.end();
  if (name != names.end()) {
    index = static_cast<int>(name - names.begin());
    return;
  }
  const std::string hint =
      found->is_string() ? didYouMean(found->get_ref<const std::string&>(), names, "") : std::string();
  wrong(key, expected, describeJson(*found) + hint);
}

void JsonReader::object(std::string_view key, const FieldDoc& doc, const Fields& fields, bool* present) {
  const Json* const found = find(key, doc, "an object");
  if (present != nullptr) *present = found != nullptr;
  if (found == nullptr) return;
  if (!found->is_object()) {
    wrong(key, "an object", describeJson(*found));
    return;
  }
  const std::size_t before = faults_.size();
  read(*found, childPointer(pointer_, key), faults_, fields);
  if (faults_.size() > before) faulty_.emplace(key);
}

void JsonReader::list(std::string_view key, std::size_t, const FieldDoc& doc,
                      const std::function<void(FieldVisitor&, std::size_t)>& element) {
  const Json* const found = find(key, doc, "an array of objects");
  if (found == nullptr) return;
  if (!found->is_array()) {
    wrong(key, "an array of objects", describeJson(*found));
    return;
  }
  const std::size_t before = faults_.size();
  const std::string pointer = childPointer(pointer_, key);
  for (std::size_t k = 0; k < found->size(); ++k) {
    const std::string place = childPointer(pointer, k);
    if ((*found)[k].is_object()) {
      read((*found)[k], place, faults_, [&](FieldVisitor& fields) { element(fields, k); });
    } else {
      faults_.add(place, "expected an object, found " + describeJson((*found)[k]));
    }
  }
  if (faults_.size() > before) faulty_.emplace(key);
}

void JsonReader::variant(std::string_view key, int& index, std::span<const std::string_view> names,
                         const FieldDoc& doc, const std::function<void(FieldVisitor&, int)>& fields) {
  index = -1;
  choice(key, index, names, doc);
  if (index >= 0) {
    fields(*this, index);
  } else {
    openEnded_ = true;
  }
}

void JsonReader::fault(std::string_view key, std::string_view message) {
  if (faulty_.contains(key)) return;
  faults_.add(key.empty() ? pointer_ : childPointer(pointer_, key), std::string(message));
  if (!key.empty()) faulty_.emplace(key);
}

void JsonReader::warning(std::string_view key, std::string_view message) {
  faults_.warn(key.empty() ? pointer_ : childPointer(pointer_, key), message);
}

bool JsonReader::valid(std::initializer_list<std::string_view> keys) const {
  return std::none_of(keys.begin(), keys.end(), [&](std::string_view key) { return faulty_.contains(key); });
}

void JsonReader::reportUnknownKeys() {
  if (openEnded_) return;
  for (const auto& item : object_.items()) {
    if (std::find(known_.begin(), known_.end(), item.key()) != known_.end()) continue;
    faults_.add(childPointer(pointer_, item.key()),
                "expected a known key, found " + quotedText(item.key()) +
                    didYouMean(item.key(), known_, "; known here: " + quotedList(known_)));
  }
}

namespace {

constexpr std::string_view kSpacing = "/particle_spacing";

/// What takes the whole scene to see: too many steps, too many particles for this machine, or too far away
/// for a float's digits.
void checkWhole(const Scene& scene, FaultList& faults) {
  if (!faults.anyBelow("/duration") && !faults.anyBelow("/solver"))
    if (const auto fault = tooShortStep(scene.solver, scene.duration))
      faults.add("/solver/time_step", *fault);
  if (faults.anyBelow("/fluid") || faults.anyBelow("/emitters") || faults.anyBelow(kSpacing)) return;
  const double spacing = scene.particleSpacing;
  const auto count = [&](double other) { return particleCount(scene, other, scene.duration); };
  if (const auto fault = tooManyParticles(count, spacing, availableMemory())) faults.add(kSpacing, *fault);

  Bounds fluid;
  for (const auto& source : scene.fluid) fluid.include(source->bounds());
  for (const Emitter& emitter : scene.emitters) fluid.include(emitter.bounds());
  if (fluid.empty()) return;
  const double farthest = std::max(fluid.min.cwiseAbs().maxCoeff(), fluid.max.cwiseAbs().maxCoeff());
  const double coarsest = farthest * double(std::numeric_limits<float>::epsilon());
  if (coarsest > spacing / 100) {
    std::ostringstream text;
    text << "expected at least " << 100 * coarsest << " m for fluid as far from the origin as " << farthest
         << " m, where positions are " << coarsest << " m apart, found " << spacing
         << " m; move the scene to the origin or use a larger spacing";
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
  JsonReader::read(root, "", faults, [&](FieldVisitor& fields) { describeScene(fields, scene); });
  named = faults.files();
  checkWhole(scene, faults);
  if (!faults.empty()) throw InputError(faults.faults());
  scene.warnings = faults.warnings();
  if (scene.name.empty()) scene.name = scene.stem();
  return scene;
}

std::vector<std::filesystem::path> filesNamedBy(const Scene& scene) {
  std::vector<std::filesystem::path> files;
  JsonWriter::write([&](FieldWriter& fields) { describeScene(fields, scene); },
                    [&](const FileName& name) {
                      for (std::filesystem::path& file : filesOfShape(name.path))
                        files.push_back(std::move(file));
                      return Json(name.written);
                    });
  return files;
}

Scene readScene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return parseScene(readTextFile(file, "a scene file"), file, overrides);
}

}  // namespace migiwa
