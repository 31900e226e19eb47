// What `migiwa render` was asked for, and the styles that draw it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/command.h"
#include "app/render/image.h"
#include "core/scene/scene.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"

namespace migiwa {

inline constexpr int kSheetGutter = 6;  ///< between the cells of a sheet (pixels)

/// The first is the one that is taken where none is named.
inline constexpr std::array<std::string_view, 2> kRenderStyles{"particles", "raytraced"};

inline constexpr long kFewestSamples = 2, kMostSamples = 65536;  ///< of a pixel

struct RenderOptions {
  std::string scene, out, times, size = "1280x720", compare, style{kRenderStyles[0]};
  bool panels = false, timings = false;
  std::optional<int> samples;
  std::optional<long> seed;
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
  bool rayTraced = false;
  int samples = 64;  ///< of each pixel of a ray-traced picture
  std::uint32_t seed = 0;
};

/// Throws InputError with every fault found.
RenderJob checkedRenderJob(const RenderOptions& options, const CommonOptions& common);

/// Draws one run of a scene; simulations go on between its pictures.
class PictureTaker {
 public:
  virtual ~PictureTaker() = default;
  virtual Image take(const Simulation& simulation, const FrameView& frame) = 0;
};

/// By rays; `threads` as in CommonOptions. Throws MissingError where the program has none.
std::unique_ptr<PictureTaker> makeStillTaker(const RenderJob& job, int threads);

}  // namespace migiwa
