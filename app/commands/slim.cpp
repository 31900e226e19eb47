// `migiwa slim MESH --out FILE.json`: fits a SLIM surface to a mesh or an oriented point cloud, and draws it.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "app/commands/command.h"
#include "app/commands/fault_collector.h"
#include "app/commands/slim_picture.h"
#include "app/render/png.h"
#include "core/base/error.h"
#include "core/io/output_file.h"
#include "core/slim/slim_file.h"

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
  const bool shown = !common.quiet && isatty(STDERR_FILENO) == 1;
  const auto start = std::chrono::steady_clock::now();
  SlimData data = fitShape(shape, wanted, pool, [shown](double part) {
    if (shown) std::fprintf(stderr, "\rfitting: %3.0f %%", 100 * part);
  });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (shown) std::fputs("\r\033[K", stderr);
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
  return {"slim", "Fits a SLIM surface to a mesh or to points with normals.", [](CLI::App& parser) {
            const auto options = std::make_shared<SlimOptions>();
            parser
                .add_option("mesh", options->mesh, "OBJ, PLY, STL, ...: triangles, or points with normals.")
                ->required()
                ->type_name("MESH");
            parser
                .add_option("--out", options->out,
                            "Where the surface goes; a picture of it, FILE.png, beside it.")
                ->required()
                ->type_name("FILE.json");
            parser.add_option("--degree", options->degree, "Degree of the polynomials.")
                ->check(CLI::Range(1, kLargestSlimDegree))
                ->default_str("2")
                ->type_name("1|2|3");
            const auto tolerance = parser.add_option("--tolerance", options->tolerance,
                                                     "Largest distance of a polynomial to the input, in the "
                                                     "file's unit; left out: a thousandth of the diagonal.");
            tolerance->type_name("M");
            parser.add_option("--nodes", options->nodes, "Fits about so many nodes instead.")
                ->check(CLI::Range(10, 5'000'000))
                ->excludes(tolerance)
                ->type_name("N");
            return [options](const CommonOptions& common) { return fit(*options, common); };
          }};
}

}  // namespace migiwa
