// Scene files (format 1): read, written, edited and described.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/base/messages.h"
#include "core/scene/scene.h"

namespace migiwa {

// Scene files (format 1) into validated scenes. The only place besides core/io that knows JSON.

/// One `--set /json/pointer=VALUE`.
struct Override {
  std::string pointer;
  std::string value;  ///< a JSON value, or a bare word taken as a string
  /// Splits at the first '='; throws InputError when there is none or the pointer does not begin with '/'.
  static Override parse(std::string_view argument);
};

/// Reads, applies the overrides, validates. Throws InputError with every fault found.
Scene readScene(const std::filesystem::path& file, const std::vector<Override>& overrides = {});
/// The same for a text in memory; `name` stands in for the file in faults, and names of files are relative to
/// its folder.
Scene parseScene(std::string_view text, const std::filesystem::path& name = "scene.json",
                 const std::vector<Override>& overrides = {});

/// The scene's file and those that it includes, outermost first, as far as they can be found.
std::vector<std::filesystem::path> filesOfScene(const std::filesystem::path& file);

/// Visits every key of a scene: the one list that reading, writing and documentation share.
void describeScene(FieldVisitor& visitor, Scene& scene);
void describeScene(FieldWriter& visitor, const Scene& scene);

// A scene back as a scene file.

/// The normalised text: every key with its value in force, defaults and the chosen camera included. Reading
/// it gives the same scene.
std::string writeScene(const Scene& scene);

// The files that a scene is made of beside its own: scenes that it includes, meshes, points and SLIM
// surfaces. For whoever waits for one of them to change.

/// Meshes, points and SLIM surfaces that a valid scene names, with the files that these refer to.
std::vector<std::filesystem::path> filesNamedBy(const Scene& scene);

/// As parseScene() without `named`, which becomes the meshes, points and SLIM surfaces that the text names,
/// also when it throws for faults in one of them or elsewhere.
Scene parseScene(std::string_view text, const std::filesystem::path& name,
                 const std::vector<Override>& overrides, std::vector<std::filesystem::path>& named);

// A scene file as a text that a person edits: where in it a fault is, and how what has changed since is
// written into it.

/// The lines, from 1, of faults in the text of `file`; 0 for one that lies elsewhere: in a file that is
/// included, or in an option.
std::vector<int> linesOfFaults(std::span<const Fault> faults, std::string_view text,
                               const std::filesystem::path& file);

/// The text of a scene file that reads back as `scene`: `text` with as little changed as that takes. `scene`
/// must be one that no other thread uses, read from `text`, perhaps with options, and changed in its settings
/// and its view. Throws InputError when `text` itself has faults.
std::string sceneTextWith(std::string_view text, const std::filesystem::path& file, const Scene& scene);

/// Equal for two scenes that differ in nothing but what a running simulation can take over: settings of the
/// solver and the walls' correction, effects, the view, and words. Files that a scene names count with their
/// content.
std::string startOf(Scene scene);

/// Where the settings of two scenes differ, as options of --set that lead from one to the other:
/// "/solver/tolerance=0.01". Names, duration and view do not count; "none" stands for a key that goes.
std::vector<std::string> changesBetween(const Scene& from, const Scene& to);

/// The same of their views, with "null" for a key that goes: all of them can be given to --set.
std::vector<std::string> viewChangesBetween(const Scene& from, const Scene& to);

// The scene format for editors and for people, made from the list of fields that the reader uses.

/// JSON Schema (draft 2020-12) of a scene file, `scenes/scene.schema.json`.
std::string sceneSchema();

/// Every key in Markdown tables, the reference in `scenes/README.md`.
std::string sceneReference();

}  // namespace migiwa
