// Effects as a scene file names them, for scenes put together in code.
#pragma once

#include <string>

#include "core/scene/scene_file.h"

namespace migiwa::testing {

/// `json`: what stands under "effects" in a scene file.
inline std::vector<NamedEffect> effectsOf(const std::string& json) {
  return parseScene(R"({"format": 1, "particle_spacing": 0.05, "effects": )" + json + "}", "effects.json")
      .effects;
}

}  // namespace migiwa::testing
