// What `migiwa render` was asked for, looked at and understood before anything is drawn or written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "core/scene/scene.h"

namespace migiwa {

inline constexpr int kSheetGutter = 6;  ///< between the cells of a sheet (pixels)

struct RenderOptions {
  std::string scene, out, times, size = "1280x720", compare;
  bool panels = false, timings = false;
};

/// One run of the scene: what is changed in it, and how that is called on the picture.
struct RenderVariant {
  std::vector<Override> overrides;
  std::string note;
  Scene scene;
};

struct RenderJob {
  std::vector<RenderVariant> variants;  ///< one, or those of --compare in the given order
  std::vector<double> times;            ///< rising (s)
  int width = 0, height = 0;            ///< of one picture or cell (pixels)
  std::filesystem::path folder;
};

/// Throws InputError with every fault found.
RenderJob checkedRenderJob(const RenderOptions& options, const CommonOptions& common);

}  // namespace migiwa
