// Scene files (format 1) into validated scenes. The only place besides core/io that knows JSON.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/fields.h"
#include "core/scene/scene.h"

namespace migiwa {

/// One `--set /json/pointer=VALUE`.
struct Override {
  std::string pointer;
  std::string value;  ///< a JSON value, or a bare word taken as a string
  /// Splits at the first '='; throws InputError when there is none or the pointer does not begin with '/'.
  static Override parse(std::string_view argument);
};

/// Reads, applies the overrides, validates. Throws InputError with every fault found.
Scene readScene(const std::filesystem::path& file, const std::vector<Override>& overrides = {});
/// The same for a text in memory; `name` stands in for the file in faults.
Scene parseScene(std::string_view text, const std::filesystem::path& name,
                 const std::vector<Override>& overrides = {});

/// The scene's file and those that it includes, outermost first, as far as they can be found.
std::vector<std::filesystem::path> filesOfScene(const std::filesystem::path& file);

/// Visits every key of a scene: the one list that reading, writing and documentation share.
void describeScene(FieldVisitor& visitor, Scene& scene);
void describeScene(FieldWriter& visitor, const Scene& scene);

}  // namespace migiwa
