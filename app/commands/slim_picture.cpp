#include "app/commands/slim_picture.h"

#include <algorithm>

#include "app/platform/egl_context.h"
#include "app/render/renderer.h"
#include "app/ui/number_text.h"
#include "app/ui/ui.h"
#include "core/boundary/slim_surface.h"
#include "core/scene/default_camera.h"

namespace migiwa {
namespace {

constexpr int kWidth = 800, kHeight = 720;
constexpr int kGutter = 6;  ///< between the halves (pixels)

/// The default camera leaves room for whatever moves around a scene; a shape alone is looked at from nearer.
Camera cameraFor(const Bounds& bounds) {
  constexpr double kNearer = 0.85;
  Camera camera = defaultCamera(bounds, -Vec3d::UnitY());
  camera.eye = camera.target + kNearer * (camera.eye - camera.target);
  return camera;
}

Caption surfaceCaption(const SlimData& data) {
  const SlimStatistics& statistics = data.statistics;
  return {statistics.source,
          {{"nodes", groupedDigits(data.nodes.size())},
           {"degree", std::to_string(data.degree)},
           {"largest distance", formatNumber("%.3g m", statistics.largest)},
           {"mean distance", formatNumber("%.3g m", statistics.mean)}}};
}

Caption nodesCaption(const SlimData& data) {
  const auto [least, most] =
      std::minmax_element(data.nodes.begin(), data.nodes.end(),
                          [](const SlimNode& a, const SlimNode& b) { return a.radius < b.radius; });
  return {"Its balls, each as a disc as wide as its core",
          {{"smallest radius", formatNumber("%.3g m", static_cast<double>(least->radius))},
           {"largest radius", formatNumber("%.3g m", static_cast<double>(most->radius))}}};
}

}  // namespace

Image drawSlim(const SlimData& data, ThreadPool& pool) {
  const auto context = makeEglContext();
  const auto wall = std::make_shared<SlimWallData>();
  wall->model = std::make_unique<const SlimModel>(data.nodes, data.degree, data.closed, pool);
  const SlimSurface surface(wall, SlimSurface::Fluid::outside);
  Surroundings surroundings;
  surroundings.walls.meshes.push_back(surface.mesh());
  surface.drawnNodes(surroundings.walls.nodes);
  surroundings.bounds = surroundings.walls.meshes.front().surface.bounds();
  Renderer renderer(surroundings, makeColorMap());
  Ui ui(1);
  const RenderTarget target(kWidth, kHeight);
  const FrameSnapshot nothing;
  Shot shot;
  shot.camera = cameraFor(surroundings.bounds);
  shot.scene = {0, 0, kWidth, kHeight};

  Image picture(2 * kWidth + kGutter, kHeight);
  std::fill(picture.rgba.begin(), picture.rgba.end(), std::uint8_t{255});
  for (const bool nodes : {false, true}) {
    shot.nodes = nodes;
    target.beginScene();
    renderer.draw(nothing.view(), shot, target);
    target.beginOverlay();
    ui.begin(kWidth, kHeight, InputState{});
    ui.caption(nodes ? nodesCaption(data) : surfaceCaption(data), shot.scene);
    if (nodes) ui.legend(NodePass::legend(), renderer.nodes().range(), makeWarmColorMap(), shot.scene);
    ui.end(true);
    picture.paste(target.read(), nodes ? kWidth + kGutter : 0, 0);
  }
  return picture;
}

}  // namespace migiwa
