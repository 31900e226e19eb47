// JSON, for the readers and writers alone: documents, the faults of their texts with where they come from,
// includes and overrides.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/fields.h"
#include "core/base/messages.h"
#include "core/scene/scene_file.h"

namespace migiwa {

struct Scene;

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
// The library's reader and writer are compiled in one file each: that takes seconds.

/// The same where no user writes the text. Throws Json::exception.
Json readJson(std::string_view text);
/// Text without spaces. What is no UTF-8 is replaced.
std::string compactJson(const Json& value);

/// `pointer` with one more token, escaped as RFC 6901 asks.
std::string childPointer(std::string_view pointer, std::string_view key);
std::string childPointer(std::string_view pointer, std::size_t index);

/// Nothing if the text does not begin with '/' or an escape is wrong.
std::optional<Json::json_pointer> parsePointer(std::string_view text);
/// From the outermost one on, without escapes.
std::vector<std::string> tokensOf(Json::json_pointer pointer);

/// The bytes at which values begin in a text that is JSON, or their keys, or as much of the way as there is;
/// pointers are escaped, and that of the whole is empty.
std::vector<std::size_t> offsetsOf(std::string_view text, std::span<const std::string> pointers);

/// What a value is, for "found ...": numbers and short texts themselves, else the kind with its size.
std::string describeJson(const Json& value);

/// A text in quotes, escaped, and shortened when it is long.
std::string quotedText(std::string_view text);

/// Indented text in which arrays of plain values stay on one line. Ends with a newline.
std::string prettyJson(const Json& value);

// Where each value of a scene was written. A scene is put together from a file, the files that it includes,
// their "set" and the options --set; a fault has to name the one that a person has to change.

/// The place of a value.
struct Origin {
  std::string file;     ///< as it was named; empty for the option --set
  std::string pointer;  ///< in that file, or behind --set
  bool whole = false;   ///< made on the way to this place: what is below it has no place of its own

  /// `FILE:/pointer` or `--set /pointer`.
  std::string text() const;
};

// Faults of one scene while it is read: JSON pointers in, places that the user wrote out.

class FaultList {
 public:
  /// All values were written in `file`, at the pointer that they have.
  explicit FaultList(std::string file);

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

  /// The value at `pointer` of the whole scene, and all below it, now comes from `origin`.
  void addOrigin(std::string pointer, Origin origin);
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

  /// Of the value at `pointer`, which need not exist: then of the object that lacks it.
  Origin originOf(std::string_view pointer) const;

  std::string file_;
  std::vector<Part> parts_;  ///< in the order in which they were put over each other
  std::vector<std::string> pointers_;
  std::vector<Fault> faults_;
  std::vector<std::string> warnings_;
  std::vector<std::filesystem::path> files_;
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

/// Puts values in by JSON pointer, in order, as `--set /json/pointer=VALUE` and "set" in a scene file do:
/// objects on the way that are missing are made, entries of arrays are not; the last token "-" adds an entry
/// to an array, and null takes a member out of its object.
void applyOverrides(const std::vector<Override>& overrides, Json& root, FaultList& faults);

// Where a scene is that is far from zero.

/// What the positions of the scene written as `root` are relative to (Scene::origin): zero where floats hold
/// a thousandth of a spacing, else a round number within the scene's extent on each axis. `faults` tells
/// where its files are.
Vec3d originOf(const Json& root, const FaultList& faults);

// Where things are and how large, beside each other.

/// Faults of vessels that share no room, as the scene written as `root` has them; warnings of shapes from
/// files that look like millimetres, or like metres among millimetres, and of walls that are nowhere near the
/// fluid.
void checkPlaces(const Scene& scene, const Json& root, FaultList& faults);

}  // namespace migiwa
