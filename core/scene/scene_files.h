// The files that a scene is made of beside its own: scenes that it includes, meshes, points and SLIM
// surfaces. For whoever waits for one of them to change.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/scene/scene_reader.h"

namespace migiwa {

/// Meshes, points and SLIM surfaces that a valid scene names, with the files that these refer to.
std::vector<std::filesystem::path> filesNamedBy(const Scene& scene);

/// As parseScene() without `named`, which becomes the meshes, points and SLIM surfaces that the text names,
/// also when it throws for faults in one of them or elsewhere.
Scene parseScene(std::string_view text, const std::filesystem::path& name,
                 const std::vector<Override>& overrides, std::vector<std::filesystem::path>& named);

}  // namespace migiwa
