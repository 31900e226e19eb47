// A scene back as a scene file.
#pragma once

#include <string>

#include "core/scene/scene.h"

namespace migiwa {

/// The normalised text: every key with its value in force, defaults and the chosen camera included. Reading
/// it gives the same scene.
std::string writeScene(const Scene& scene);

}  // namespace migiwa
