// `migiwa slim MESH --out FILE.json`: fits a SLIM surface to a mesh or an oriented point cloud, and draws it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "app/commands/command.h"
#include "app/commands/plots.h"
#include "app/platform/context.h"
#include "app/render/image.h"
#include "app/render/renderer.h"
#include "app/ui/ui.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/scene/scene.h"
#include "core/slim/file.h"
#include "core/walls/slim_wall.h"

namespace migiwa {

namespace {

struct SlimOptions {
  std::string mesh, out;
  int degree = 2;
  std::optional<double> tolerance;  ///< (m)
  std::optional<int> nodes;
};

/// Beside the surface's file.
std::filesystem::path pictureFile(const SlimOptions& options) {
  return std::filesystem::path(options.out).replace_extension(".png");
}

/// What was given, or every fault of it.
ImportedShape checkedShape(const SlimOptions& options, const CommonOptions& common) {
  FaultCollector collect;
  if (!common.overrides.empty())
    collect.add({"--set", "expected no change of a scene, which this command does not read"});
  if (options.tolerance && !(*options.tolerance > 0 && *options.tolerance <= 1e6))
    collect.add({"--tolerance",
                 "expected a number in (0, 1e+06] (unit: m), found " + std::to_string(*options.tolerance)});
  if (pictureFile(options) == options.out)
    collect.add({"--out", "expected a name that does not end in .png, which its picture will have; found " +
                              options.out});
  collect([&] { requireWritable(options.out, "--out"); });
  std::optional<ImportedShape> shape;
  collect([&] { shape = importShape(options.mesh); });
  collect.raise();
  return *std::move(shape);
}

/// A machine without EGL goes without the picture.
void drawPicture(const SlimOptions& options, const SlimData& data, ThreadPool& pool) {
  const std::filesystem::path file = pictureFile(options);
  std::string picture;
  try {
    picture = encodePng(drawSlim(data, pool));
  } catch (const MissingError& error) {
    std::cerr << "note: no picture " << file.string() << ": " << error.what() << '\n';
    return;
  }
  writeTextFile(file, picture);
  std::printf("picture          %s\n", file.c_str());
}

int fit(const SlimOptions& options, const CommonOptions& common) {
  const ImportedShape shape = checkedShape(options, common);
  for (const std::string& note : shape.notes) std::cerr << options.mesh << ": warning: " << note << '\n';
  SlimFitOptions wanted;
  wanted.degree = options.degree;
  wanted.tolerance = options.tolerance.value_or(0);
  wanted.nodes = options.nodes.value_or(0);

  ThreadPool pool(common.threads);
  const auto start = std::chrono::steady_clock::now();
  SlimData data = fitShape(shape, wanted, pool);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  data.statistics.source = std::filesystem::path(options.mesh).filename().string();
  writeTextFile(options.out, slimFileText(data));

  std::printf(
      "nodes            %zu of degree %d\n"
      "largest distance %.3g m (%.2g of the diagonal)\n"
      "mean distance    %.3g m\n"
      "time             %.2f s\n",
      data.nodes.size(), data.degree, data.statistics.largest,
      data.statistics.largest / shape.bounds().size().norm(), data.statistics.mean, seconds);
  drawPicture(options, data, pool);
  return kDone;
}

}  // namespace

Command slimCommand() {
  return {
      "slim", "Fits a SLIM surface to a mesh or to points with normals.", [] {
        const auto options = std::make_shared<SlimOptions>();
        return Declaration{
            {{.name = "mesh",
              .target = &options->mesh,
              .value = "MESH",
              .help = "OBJ, PLY, STL, ...: triangles, or points with normals.",
              .required = true},
             {.name = "--out",
              .target = &options->out,
              .value = "FILE.json",
              .help = "Where the surface goes; a picture of it, FILE.png, beside it.",
              .required = true},
             {.name = "--degree",
              .target = &options->degree,
              .value = "1|2|3",
              .help = "Degree of the polynomials.",
              .range = {{1, kLargestSlimDegree}},
              .shownDefault = "2"},
             {.name = "--tolerance",
              .target = &options->tolerance,
              .value = "M",
              .help =
                  "Largest distance of a polynomial to the input, in the file's unit; left out: a thousandth "
                  "of the diagonal."},
             {.name = "--nodes",
              .target = &options->nodes,
              .value = "N",
              .help = "Fits about so many nodes instead.",
              .range = {{10, 5'000'000}},
              .excludes = {"--tolerance"}}},
            [options](const CommonOptions& common) { return fit(*options, common); }};
      }};
}

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
