// A scene file as a text that a person edits: where in it a fault is, and how what has changed since is
// written into it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace migiwa {

/// The line, from 1, of a fault in the text of `file`; 0 when it lies elsewhere: in a file that is included,
/// or in an option.
int lineOfFault(const Fault& fault, std::string_view text, const std::filesystem::path& file);

/// The text of a scene file that reads back as `scene`: `text` with as little changed as that takes. `scene`
/// must be one that no other thread uses, read from `text`, perhaps with options, and changed in its settings
/// and its view. Throws InputError when `text` itself has faults.
std::string sceneTextWith(std::string_view text, const std::filesystem::path& file, const Scene& scene);

/// Equal for two scenes that differ in nothing but what a running simulation can take over: settings of the
/// solver and the walls' correction, effects, the view, and words. Files that a scene names count with their
/// content.
std::string startOf(Scene scene);

}  // namespace migiwa
