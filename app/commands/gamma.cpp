// `migiwa gamma SCENE`: gamma at given points, or as a map with its error: the paper's Figure 3.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <sstream>

#include "app/commands/command.h"
#include "app/commands/plots.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/base/parallel.h"
#include "core/gamma/gamma_method.h"
#include "core/io/points_csv.h"
#include "core/simulation/gauges.h"

namespace migiwa {

namespace {

struct GammaOptions {
  std::string scene, points, out, map, window;
  bool allMethods = false;
};

/// Of coordinates: more than `near` where a scene is far from zero.
int digitsAt(const Scene& scene, int near) {
  constexpr int kFar = 15;
  return scene.origin.isZero(0) ? near : kFar;
}

void evaluatePoints(const GammaOptions& options, const Scene& scene, const CommonOptions& common) {
  requireWritable(options.out, "--out");
  const std::vector<Vec3d> points = readPoints(options.points);
  const std::vector<WallAnswer> answers = WallQuery(scene, common.threads).answers(points);
  const int digits = digitsAt(scene, 9);
  std::string text = "x,y,z,gamma,gradient_x,gradient_y,gradient_z,distance\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d& p = points[i];
    const WallAnswer& wall = answers[i];
    char row[256];
    std::snprintf(row, sizeof row, "%.*g,%.*g,%.*g,%.7g,%.7g,%.7g,%.7g,%.7g\n", digits, p.x(), digits, p.y(),
                  digits, p.z(), wall.gamma, wall.gradient.x(), wall.gradient.y(), wall.gradient.z(),
                  wall.distance);
    text += row;
  }
  writeTextFile(options.out, text);
}

/// Points of a map have to be apart for a float, and its picture has to have both sides.
void requireMappable(const std::array<double, 4>& corners) {
  constexpr double kFinest = 1e-4, kMostLopsided = 1000;
  const double width = corners[2] - corners[0], height = corners[3] - corners[1];
  double farthest = 0;
  for (const double corner : corners) farthest = std::max(farthest, std::abs(corner));
  const double least =
      std::max({kFinest * farthest, std::max(width, height) / kMostLopsided, Range::kSmallestLength});
  if (width >= least && height >= least) return;
  std::ostringstream text;
  text << "expected sides of at least " << least << " m for a window of this extent, found " << width
       << " by " << height << " m";
  throw InputError("--window", text.str());
}

/// `x0,y0,x1,y1` in m, or nothing: all of the scene in the cut, or three support radii about the origin where
/// no wall is finite.
MapWindow windowOf(const GammaOptions& options, const Scene& scene) {
  MapWindow window;
  const Bounds bounds = scene.bounds();
  window.axis = static_cast<int>(scene.view.clip.axis);
  window.at = scene.view.clip.enabled ? scene.view.clip.at
              : bounds.empty()        ? 0
                                      : bounds.center()[window.axis];
  window.across = window.axis == 0 ? 2 : 0;
  window.up = window.axis == 1 ? 2 : 1;
  const double reach = 1.5 * scene.supportRadius();
  std::array<double, 4> corners{-reach, -reach, reach, reach};
  if (!bounds.empty())
    corners = {bounds.min[window.across], bounds.min[window.up], bounds.max[window.across],
               bounds.max[window.up]};
  if (!options.window.empty()) {
    const bool valid = readNumbers(options.window, corners);
    if (!valid || corners[0] >= corners[2] || corners[1] >= corners[3])
      throw InputError("--window", "expected x0,y0,x1,y1 in m, the lower left corner first, found '" +
                                       options.window + "'");
  }
  if (!options.window.empty()) {
    for (std::size_t k = 0; k < corners.size(); ++k)
      corners[k] -= scene.origin[k % 2 == 0 ? window.across : window.up];
    requireMappable(corners);
  }
  window.low[0] = corners[0], window.low[1] = corners[1];
  window.high[0] = corners[2], window.high[1] = corners[3];
  // Square cells, some 50,000 of them: what a picture shows.
  const double width = corners[2] - corners[0], height = corners[3] - corners[1];
  const double cell = std::sqrt(width * height / 50000);
  // A window of next to no area has cells of no size.
  const auto cellsAlong = [&](double length) {
    const double cells = cell > 0 ? std::round(length / cell) : 2;
    return static_cast<int>(std::clamp(cells, 2.0, 2000.0));
  };
  window.columns = cellsAlong(width);
  window.rows = cellsAlong(height);
  return window;
}

/// The same in the coordinates of the scene's file.
MapWindow shownWindow(MapWindow window, const Scene& scene) {
  window.at += scene.origin[window.axis];
  for (double* const corner : {window.low, window.high}) {
    corner[0] += scene.origin[window.across];
    corner[1] += scene.origin[window.up];
  }
  return window;
}

struct MethodMap {
  std::string name;
  std::vector<float> gamma, error;
  double largest = 0, mean = 0;
};

MethodMap mapOf(const PickedGamma& picked, const std::vector<float>& reference, const Boundary& boundary,
                const MapWindow& window, ThreadPool& pool) {
  MethodMap map{picked.name, gammaMap(*picked.method, boundary, window, pool), {}};
  long count = 0;
  for (std::size_t k = 0; k < map.gamma.size(); ++k) {
    map.error.push_back(map.gamma[k] - reference[k]);
    if (!std::isfinite(map.error.back())) continue;
    const double size = std::abs(static_cast<double>(map.error.back()));
    map.largest = std::max(map.largest, size);
    map.mean += size;
    ++count;
  }
  map.mean /= static_cast<double>(std::max(count, 1L));
  return map;
}

std::string mapCsv(const MapWindow& window, int digits, const std::vector<float>& reference,
                   const std::vector<MethodMap>& maps) {
  std::string text = "x,y,z,reference";
  for (const MethodMap& map : maps) text += "," + map.name + "," + map.name + "_error";
  text += '\n';
  std::size_t k = 0;
  for (int row = 0; row < window.rows; ++row) {
    for (int column = 0; column < window.columns; ++column, ++k) {
      if (!std::isfinite(reference[k])) continue;  // in the solid
      const Vec3d p = window.point(column, row);
      char cell[128];
      std::snprintf(cell, sizeof cell, "%.*g,%.*g,%.*g,%.6f", digits, p.x(), digits, p.y(), digits, p.z(),
                    static_cast<double>(reference[k]));
      text += cell;
      for (const MethodMap& map : maps) {
        std::snprintf(cell, sizeof cell, ",%.6f,%.6f", static_cast<double>(map.gamma[k]),
                      static_cast<double>(map.error[k]));
        text += cell;
      }
      text += '\n';
    }
  }
  return text;
}

std::string titled(const char* quantity, const MethodMap& map) {
  char text[160];
  std::snprintf(text, sizeof text, "%s, %s: largest %.4f, mean %.4f", quantity, map.name.c_str(), map.largest,
                map.mean);
  std::string result = text;
  std::replace(result.begin(), result.end(), '_', ' ');
  return result;
}

void drawMap(const GammaOptions& options, const Scene& scene, ThreadPool& pool) {
  const Boundary boundary(wallsFor(scene.surfaces, static_cast<float>(scene.supportRadius())));
  if (boundary.empty())
    throw InputError(options.scene + ":/boundary/surfaces", "expected a wall to map gamma at, found none");
  const MapWindow window = windowOf(options, scene);
  const std::filesystem::path folder(options.map);
  makeFolder(folder, "--map");
  const std::string stem = (folder / (scene.stem() + (options.allMethods ? "_methods" : "_gamma"))).string();
  requireWritable(stem + ".csv", "--map");

  GammaContext context = gammaContextOf(scene, boundary, pool);
  context.region = {};
  context.region.include(window.point(0, 0));
  context.region.include(window.point(window.columns - 1, window.rows - 1));
  const std::vector<float> reference = gammaMap(*referenceGamma(context).method, boundary, window, pool);
  std::vector<MethodMap> maps;
  std::vector<MapPanel> panels;
  if (options.allMethods) {
    const auto names = gammaMethodNames();
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (names[k] == "monte_carlo") continue;  // hours, for a picture of its noise
      PickedGamma picked = makeGammaMethod(static_cast<int>(k), context);
      picked.name = names[k];
      maps.push_back(mapOf(picked, reference, boundary, window, pool));
      panels.push_back({titled("error", maps.back()), maps.back().error, true});
    }
    for (std::size_t k = 0; k < handlingNames().size(); ++k) {
      const auto handling = static_cast<BoundaryHandling>(k);
      if (handling == BoundaryHandling::gamma || handling == BoundaryHandling::none) continue;
      maps.push_back(mapOf(makeHandling(handling, 0, context), reference, boundary, window, pool));
      panels.push_back({titled("error", maps.back()), maps.back().error, true});
    }
  } else {
    maps.push_back(mapOf(gammaMethodOf(scene, context), reference, boundary, window, pool));
    panels.push_back({"γ, " + maps.back().name, maps.back().gamma, false});
    panels.push_back({titled("error", maps.back()), maps.back().error, true});
  }
  const MapWindow shown = shownWindow(window, scene);
  writeTextFile(stem + ".csv", mapCsv(shown, digitsAt(scene, 7), reference, maps));
  std::cout << stem << ".csv\n";
  constexpr double kPaperScale = 0.25;  // the error of Eq. 14 at a right angle: one scale for every picture
  plotMaps(stem + ".png", window, scene.origin, panels, 3, kPaperScale);
  std::cout << stem << ".png\n";
  for (const MethodMap& map : maps)
    std::printf("%-12s largest error %.4f, mean %.5f\n", map.name.c_str(), map.largest, map.mean);
}

int gamma(const GammaOptions& options, const CommonOptions& common) {
  std::vector<Fault> faults;
  if (options.points.empty() != options.out.empty())
    faults.push_back(
        {options.points.empty() ? "--points" : "--out", "expected --points and --out together, found one"});
  if (options.points.empty() && options.out.empty() && options.map.empty())
    faults.push_back({"gamma", "expected --points IN.csv --out OUT.csv, or --map DIR, found neither"});
  if (!faults.empty()) throw InputError(std::move(faults));
  const Scene scene = readScene(options.scene, common.overrides);
  if (!options.points.empty()) evaluatePoints(options, scene, common);
  if (!options.map.empty()) {
    ThreadPool pool(common.threads);
    drawMap(options, scene, pool);
  }
  return kDone;
}

}  // namespace

Command gammaCommand() {
  return {"gamma", "Evaluates gamma at points, or maps it and its error on a cut.", [] {
            const auto options = std::make_shared<GammaOptions>();
            return Declaration{
                {{.name = "scene",
                  .target = &options->scene,
                  .value = "SCENE",
                  .help = "The scene file.",
                  .required = true},
                 {.name = "--points",
                  .target = &options->points,
                  .value = "IN.csv",
                  .help = "Points to evaluate at: CSV with the columns x,y,z (m)."},
                 {.name = "--out",
                  .target = &options->out,
                  .value = "OUT.csv",
                  .help = "Their gamma, its gradient (1/m) and the distance (m)."},
                 {.name = "--map",
                  .target = &options->map,
                  .value = "DIR",
                  .help = "Writes a map of gamma and its error on the scene's cut, as CSV and PNG."},
                 {.name = "--window",
                  .target = &options->window,
                  .value = "X0,Y0,X1,Y1",
                  .help = "What the map shows, in m; left out: the whole cut."},
                 {.name = "--all-methods",
                  .target = &options->allMethods,
                  .help = "Maps the error of every method side by side."}},
                [options](const CommonOptions& common) { return gamma(*options, common); }};
          }};
}

}  // namespace migiwa
