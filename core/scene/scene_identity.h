// What makes a scene the scene that it is for a simulation: two runs of scenes with the same identity are
// the same run. Titles, duration and view are not part of it.
#pragma once

#include <vector>

#include "core/scene/json_document.h"
#include "core/scene/scene.h"

namespace migiwa {

/// Every key with the value in force; for a file its name, and the identity of what was in it when the scene
/// was read.
Json sceneIdentity(const Scene& scene);

/// One fault for each place where `found` is not what `expected` has.
std::vector<DocumentFault> identityFaults(const Json& expected, const Json& found);

}  // namespace migiwa
