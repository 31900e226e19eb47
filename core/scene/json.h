// What only core/scene and core/io know of JSON: documents, the faults of their texts with where they come
// from, readers and writers of fields, includes and overrides.
#pragma once

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/fields.h"
#include "core/base/messages.h"
#include "core/scene/scene_file.h"

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

// Where each value of a scene was written. A scene is put together from a file, the files that it includes,
// their "set" and the options --set; a fault has to name the one that a person has to change.

/// Whether `pointer` is `ancestor` or lies below it.
bool isBelow(std::string_view pointer, std::string_view ancestor);

/// The place of a value.
struct Origin {
  std::string file;     ///< as it was named; empty for the option --set
  std::string pointer;  ///< in that file, or behind --set
  bool whole = false;   ///< made on the way to this place: what is below it has no place of its own

  /// `FILE:/pointer` or `--set /pointer`.
  std::string text() const;
};

class Origins {
 public:
  /// All values were written in `file`, at the pointer that they have.
  explicit Origins(std::string file);

  /// The value at `pointer` of the whole scene, and all below it, now comes from `origin`.
  void add(std::string pointer, Origin origin);
  /// Of the value at `pointer`, which need not exist: then of the object that lacks it.
  Origin of(std::string_view pointer) const;
  /// Where relative file names begin that were written at `pointer`: the folder of the file that holds them.
  /// What an option names is relative to the scene itself.
  std::filesystem::path folder(std::string_view pointer) const;
  /// The folder of the scene itself.
  std::filesystem::path sceneFolder() const;

 private:
  struct Part {
    std::string pointer;
    Origin origin;
  };

  std::string file_;
  std::vector<Part> parts_;  ///< in the order in which they were put over each other
};

// Faults of one scene while it is read: JSON pointers in, places that the user wrote out.

class FaultList {
 public:
  explicit FaultList(std::string file) : origins_(std::move(file)) {}

  /// At the value that has this pointer in the whole scene.
  void add(std::string_view pointer, std::string message);
  /// At a place of one of the files, before the scene is put together.
  void addAt(const Origin& origin, std::string message);
  /// What is valid and probably not meant: `/pointer: message`.
  void warn(std::string_view pointer, std::string_view message);
  const std::vector<std::string>& warnings() const { return warnings_; }
  std::size_t size() const { return faults_.size(); }
  bool empty() const { return faults_.empty(); }
  /// Whether there is a fault at the pointer or below it.
  bool anyBelow(std::string_view pointer) const;
  const std::vector<Fault>& faults() const { return faults_; }

  /// A file that the scene names, whether there is anything wrong with it or not.
  void noteFile(std::filesystem::path file) { files_.push_back(std::move(file)); }
  const std::vector<std::filesystem::path>& files() const { return files_; }

  Origins& origins() { return origins_; }
  const Origins& origins() const { return origins_; }

 private:
  Origins origins_;
  std::vector<std::string> pointers_;
  std::vector<Fault> faults_;
  std::vector<std::string> warnings_;
  std::vector<std::filesystem::path> files_;
};

// Reads the fields of one JSON object, and of the objects in it, into the structs that visit them. Every
// fault is collected; a faulty value leaves the default in place. Keys that nobody asked for are faults.

class JsonReader final : public FieldVisitor {
 public:
  /// Reads `object` (which must be one), found at `pointer`, through `fields`, then looks for unknown keys.
  static void read(const Json& object, const std::string& pointer, FaultList& faults, const Fields& fields);

  void number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) override;
  void integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) override;
  void boolean(std::string_view key, bool& value, const FieldDoc& doc) override;
  void text(std::string_view key, std::string& value, const FieldDoc& doc) override;
  void file(std::string_view key, FileName& value, const FieldDoc& doc) override;
  void vector(std::string_view key, Vec3d& value, const FieldDoc& doc) override;
  void triples(std::string_view key, std::vector<std::array<double, 3>>& values,
               const FieldDoc& doc) override;
  void pair(std::string_view key, std::array<double, 2>& value, const FieldDoc& doc, bool* present) override;
  void choice(std::string_view key, int& index, std::span<const std::string_view> names,
              const FieldDoc& doc) override;
  void object(std::string_view key, const FieldDoc& doc, const Fields& fields, bool* present) override;
  void list(std::string_view key, std::size_t size, const FieldDoc& doc,
            const std::function<void(FieldVisitor&, std::size_t)>& element) override;
  void variant(std::string_view key, int& index, std::span<const std::string_view> names, const FieldDoc& doc,
               const std::function<void(FieldVisitor&, int)>& fields) override;
  void fault(std::string_view key, std::string_view message) override;
  void warning(std::string_view key, std::string_view message) override;
  bool valid(std::initializer_list<std::string_view> keys) const override;

 private:
  JsonReader(const Json& object, const std::string& pointer, FaultList& faults);

  /// The value of a key, or null when it is absent: then a fault that says `expected`, if the key is
  /// required.
  const Json* find(std::string_view key, const FieldDoc& doc, const std::string& expected);
  void wrong(std::string_view key, const std::string& expected, const std::string& found);
  bool numbers(std::string_view key, const FieldDoc& doc, std::size_t size, double* values);
  void reportUnknownKeys();

  const Json& object_;
  const std::string& pointer_;
  FaultList& faults_;
  std::vector<std::string_view> known_;
  std::set<std::string, std::less<>> faulty_;
  bool openEnded_ = false;  ///< the deciding key of a variant is wrong: nobody knows which keys belong here
};

// Writes what structs visit into a JSON object: every key, with the value in force. An empty text is left
// out, it says nothing.

class JsonWriter final : public FieldWriter {
 public:
  /// What stands for a file that a scene names.
  using FileEntry = std::function<Json(const FileName&)>;

  static Json write(const Fields& fields, const FileEntry& fileEntry = {});

  void number(std::string_view key, const double& value, const Range& range, const FieldDoc& doc) override;
  void integer(std::string_view key, const int& value, const Range& range, const FieldDoc& doc) override;
  void boolean(std::string_view key, const bool& value, const FieldDoc& doc) override;
  void text(std::string_view key, const std::string& value, const FieldDoc& doc) override;
  void file(std::string_view key, const FileName& value, const FieldDoc& doc) override;
  void vector(std::string_view key, const Vec3d& value, const FieldDoc& doc) override;
  void triples(std::string_view key, const std::vector<std::array<double, 3>>& values,
               const FieldDoc& doc) override;
  void pair(std::string_view key, const std::array<double, 2>& value, const FieldDoc& doc,
            const bool* present) override;
  void choice(std::string_view key, const int& index, std::span<const std::string_view> names,
              const FieldDoc& doc) override;
  void object(std::string_view key, const FieldDoc& doc, const Fields& fields, const bool* present) override;
  void list(std::string_view key, std::size_t size, const FieldDoc& doc, const Element& element) override;
  void variant(std::string_view key, const int& index, std::span<const std::string_view> names,
               const FieldDoc& doc, const Variant& fields) override;

 private:
  void put(std::string_view key, Json value);

  Json object_ = Json::object();
  FileEntry fileEntry_;
};

// What makes a scene the scene that it is for a simulation: two runs of scenes with the same identity are
// the same run. Titles, duration and view are not part of it.

/// Every key with the value in force; for a file its name, and the identity of what was in it when the scene
/// was read.
Json sceneIdentity(const Scene& scene);

/// One fault for each place where `found` is not what `expected` has.
std::vector<DocumentFault> identityFaults(const Json& expected, const Json& found);

// A scene that names another one: "include" and "set", before a scene is read.
//
// `include` names a scene file, relative to the one that names it; its keys are taken over and the other keys
// of the including file are merged over them as JSON Merge Patch (RFC 7396) says: objects merge by key, lists
// and plain values replace, null takes a key out. `set` then changes single values by JSON pointer, as --set
// does, and so reaches into lists.

inline constexpr std::string_view kIncludeKey = "include";
inline constexpr std::string_view kSetKey = "set";
inline constexpr FieldDoc kIncludeDoc{
    "",
    "Another scene file, relative to this one, whose keys are taken over; the other keys here are merged "
    "over "
    "them: objects by key, lists and values as a whole, and null takes a key out."};
inline constexpr FieldDoc kSetDoc{
    "",
    "JSON pointers and values, put in last, as --set does: the way into lists (/fluid/0/max/1; /fluid/- adds "
    "an entry)."};

/// The document with all that it includes put together, without "include" and "set". Tells the faults'
/// origins what comes from where. Throws InputError when a file of the chain cannot be had; lesser faults are
/// added.
Json resolveIncludes(std::string_view text, const std::filesystem::path& name, FaultList& faults);

// Values put into a scene's document by JSON pointer before it is read: `--set /json/pointer=VALUE`, and the
// same under "set" in a scene file.

/// The tokens of a JSON pointer (RFC 6901); nothing if it does not begin with '/' or an escape is wrong.
std::optional<std::vector<std::string>> pointerTokens(std::string_view pointer);

/// Sets one value. Objects on the way that are missing are made, entries of arrays are not; the last token
/// "-" adds an entry to an array, and null takes a member out of its object. `origin`: where the value was
/// written.
void setValue(Json& root, const std::string& pointer, Json value, const Origin& origin, FaultList& faults);

/// Sets the values in order.
void applyOverrides(const std::vector<Override>& overrides, Json& root, FaultList& faults);

}  // namespace migiwa
