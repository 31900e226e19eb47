// `migiwa section SCENE`: a field of the liquid on a plane, as CSV and as a picture.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>

#include "app/commands/command.h"
#include "app/commands/plane.h"
#include "app/commands/plots.h"
#include "app/render/image.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/simulation/scene_section.h"
#include "core/simulation/simulation.h"

namespace migiwa {
namespace {

struct SectionOptions {
  PlaneWords what;
  std::string scene, csv, png;
  std::optional<double> time;
  std::optional<int> cells;
};

constexpr int kCellsAcross = 512, kFewestCells = 2, kMostCells = 4096;
constexpr int kErrorCells = 128;  ///< of the error of gamma, which takes long

struct SectionJob {
  Cut cut;
  SectionPlane plane;
  SectionField field = SectionField::density;
  SectionDivisor divisor = SectionDivisor::sum;
  double time = 0;  ///< (s)
};

/// Whether both name one file, which may not be there yet.
bool isOneFile(const std::string& a, const std::string& b) {
  std::error_code ignored;
  const auto place = [&](const std::string& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file, ignored), ignored);
  };
  return place(a) == place(b);
}

SectionJob checkedJob(const SectionOptions& options, const Scene& scene) {
  SectionJob job;
  FaultCollector collect;
  collect([&] { job.field = fieldOf(options.what); });
  collect([&] { job.divisor = divisorOf(options.what); });
  collect([&] {
    if (options.csv.empty() && options.png.empty())
      throw InputError("section", "expected --csv FILE or --png FILE, found neither");
    if (!options.csv.empty()) requireWritable(options.csv, "--csv");
    if (!options.png.empty()) requireWritable(options.png, "--png");
    if (!options.csv.empty() && !options.png.empty() && isOneFile(options.csv, options.png))
      throw InputError("--png", "expected another file than that of --csv, found \"" + options.png + "\"");
  });
  collect([&] {
    requireNumber("--time", options.time, Range::closed(0, kLongestRun), "s");
    job.time = options.time.value_or(0);
    requireReachable(scene, job.time, "--time");
    // As Simulation::frameAt() rounds.
    if (job.field == SectionField::pressure && job.time < 0.5 * scene.solver.timeStep)
      throw InputError("--time", "expected a step or more (" + formatNumber("%g", scene.solver.timeStep) +
                                     " s), for the pressure is that of the last step, found " +
                                     formatNumber("%g", job.time));
  });
  collect([&] {
    if (scene.bounds().empty())
      throw InputError(options.scene, "expected fluid or walls of some extent to cut through, found neither");
    job.cut = cutOf(options.what, scene);
    const int cells =
        options.cells.value_or(job.field == SectionField::gammaError ? kErrorCells : kCellsAcross);
    const Vec3d up = scene.gravity.norm() > 0 ? Vec3d(-scene.gravity) : scene.view.camera.up;
    const auto plane = sectionPlane(job.cut.normal, job.cut.offset - job.cut.normal.dot(scene.origin),
                                    scene.bounds(), up, cells);
    if (!plane) refusePlane(options.what, job.cut, scene);
    job.plane = *plane;
  });
  collect.raise();
  return job;
}

/// An axis of the picture. A scene far from zero has places relative to whole metres near it.
struct PictureAxis {
  double shift = 0, low, high;  ///< along it (m); low and high relative to the shift
  std::string label;

  PictureAxis(const Vec3d& along, const SectionPlane& plane, int cells, const Scene& scene)
      : low((plane.corner + scene.origin).dot(along)), label("along " + directionText(along, 2)) {
    if (std::abs(scene.origin.dot(along)) > 0.5) shift = std::floor(low + 1e-6 * plane.cell);
    low -= shift;
    high = low + cells * plane.cell;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      if (along[axis] > 1 - 1e-9) label = "xyz"[axis];
    if (shift != 0) label += (shift > 0 ? " - " : " + ") + formatNumber("%.0f", std::abs(shift));
    label += " (m)";
  }
};

/// The cells as gnuplot's rows of x, y and value, where a value is to have lines once more. The smallest
/// image that gnuplot takes is of 2 x 2 cells: of a single row or column each cell is two by two of them.
struct PictureCells {
  std::ostringstream text;
  bool lines = false;  ///< any cell is to have some

  PictureCells(const SectionRaster& raster, double left, double bottom, double step) {
    const SectionPlane& plane = raster.plane;
    const int parts = std::min(plane.columns, plane.rows) > 1 ? 1 : 2;
    text.precision(12);
    for (int row = 0; row < parts * plane.rows; ++row) {
      for (int column = 0; column < parts * plane.columns; ++column) {
        const float value = raster.value(column / parts, row / parts);
        text << left + (column + 0.5) * plane.cell / parts << ' ' << bottom + (row + 0.5) * plane.cell / parts
             << ' ';
        if (std::isnan(value)) {
          text << "NaN NaN\n";
          continue;
        }
        text << value << ' ';
        const bool steep = raster.steepness(column / parts, row / parts) * kFlattestLines > step;
        if (steep && parts == 1) {
          text << value << '\n';
          lines = true;
        } else {
          text << "NaN\n";
        }
      }
      text << '\n';
    }
  }
};

/// A picture with axes, lines of equal values and a legend.
void plotSection(const std::string& png, const SectionRaster& raster, const SectionJob& job,
                 const Scene& scene, const std::string& title) {
  ColorFieldInfo info = sectionFieldInfo(job.field, referenceSpeed(scene), scene.solver.restDensity);
  if (isInterpolated(job.field) && job.divisor != SectionDivisor::sum) info.low = 0;
  // How high these are depends on the moment.
  const auto range = raster.range();
  if (range && (job.field == SectionField::pressure || job.field == SectionField::speed))
    info.high = std::max(static_cast<double>((*range)[1]), 1e-6 * info.high);
  const SectionPlane& plane = raster.plane;
  const PictureAxis across(plane.across, plane, plane.columns, scene), up(plane.up, plane, plane.rows, scene);
  std::ostringstream script;
  script.precision(12);
  script << sequentialPalette() << "set cbrange [" << info.low << ':' << info.high << "]\n";
  std::string drawn = "1/0 notitle";
  if (range) {
    const std::vector<double> levels = roundTicks(info.low, info.high, 12).values;
    const double step = levels.size() > 1 ? levels[1] - levels[0] : std::numeric_limits<double>::infinity();
    const PictureCells cells(raster, across.low, up.low, step);
    script << "$map << EOD\n" << cells.text.str() << "EOD\n";
    drawn = "$map using 1:2:3 with image notitle";
    if (cells.lines) {
      script << "set contour base\nset cntrparam levels discrete ";
      for (std::size_t n = 0; n < levels.size(); ++n) script << (n > 0 ? "," : "") << levels[n];
      script << "\nunset surface\nset table $lines\nsplot $map using 1:2:4 with lines\nunset table\n";
      drawn += ", $lines using 1:2 with lines linewidth 0.8 linecolor rgb '#30000000' notitle";
    }
  } else {
    script << "set label 'no liquid on this plane' at graph 0.5, graph 0.5 center\n";
  }
  script
      << "set size ratio -1\nset xlabel " << quotedForGnuplot(across.label) << "\nset ylabel "
      << quotedForGnuplot(up.label) << "\nset xrange [" << across.low << ':' << across.high
      << "]\nset yrange [" << up.low << ':' << up.high << "]\nset tics out nomirror\nset cblabel "
      << quotedForGnuplot(info.label + (info.unit.empty() ? "" : " (" + info.unit + ")")) << "\nset title "
      << quotedForGnuplot(title)
      << "\nset object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb '#e4e7ea' fillstyle solid "
         "noborder\nplot "
      << drawn << '\n';
  const double shape = (up.high - up.low) / (across.high - across.low);
  const int width = shape > 1 ? 720 : 1100;
  const int height = std::clamp(static_cast<int>(0.78 * width * shape) + 130, 320, 1400);
  drawWithGnuplot(png,
                  "pngcairo noenhanced size " + std::to_string(width) + "," + std::to_string(height) +
                      " font 'DejaVu Sans,12'",
                  script.str());
}

int runSection(const SectionOptions& options, const CommonOptions& common) {
  const Scene scene = readScene(options.scene, common.overrides);
  const SectionJob job = checkedJob(options, scene);
  Simulation simulation(scene, common.threads);
  simulation.watchPressure(job.field == SectionField::pressure);
  TroubleNotes trouble(options.scene);
  const long last = simulation.frameAt(job.time);
  {
    ProgressBar progress(0, job.time, common.quiet);
    while (simulation.frame() < last && !simulation.stopped()) {
      simulation.advanceFrame();
      trouble.look(simulation.statistics(), progress);
      progress.update(simulation.time());
    }
  }
  if (simulation.stopped()) trouble.finish(simulation.statistics());

  ThreadPool pool(common.threads);
  const FrameView view = simulation.view();
  SceneSection sections(simulation.scene(), pool);
  const SectionRaster raster = sections.of(job.plane, job.field, job.divisor, view.positions,
                                           sectionValues(view, job.field), simulation.time());
  const ColorFieldInfo info = sectionFieldInfo(job.field, 1, scene.solver.restDensity);
  const std::string divided = !isInterpolated(job.field) || job.divisor == SectionDivisor::sum ? ""
                              : job.divisor == SectionDivisor::gamma                           ? ", over γ"
                                                                     : ", not divided";
  const std::string title =
      info.label + divided + " at " + job.cut.name + formatNumber(", %.3f s", simulation.time());
  double sum = 0;
  long wet = 0;
  for (const float value : raster.values) {
    if (std::isnan(value)) continue;
    sum += static_cast<double>(value);
    ++wet;
  }
  std::cout << title << ": " << raster.plane.columns << " x " << raster.plane.rows << " cells, " << wet
            << " of liquid";
  if (const auto range = raster.range())
    std::cout << formatNumber(", from %.6g", static_cast<double>((*range)[0]))
              << formatNumber(" to %.6g", static_cast<double>((*range)[1]))
              << formatNumber(", mean %.6g", sum / static_cast<double>(wet)) << (info.unit.empty() ? "" : " ")
              << info.unit;
  std::cout << '\n';
  if (!options.csv.empty()) {
    writeTextFile(options.csv,
                  sectionCsv(raster, scene.origin, kSectionFieldNames[static_cast<std::size_t>(job.field)]));
    std::cout << options.csv << '\n';
  }
  if (!options.png.empty()) {
    plotSection(options.png, raster, job, scene, title);
    std::cout << options.png << '\n';
  }
  return simulation.stopped() ? kNumericalTrouble : kDone;
}

std::vector<Option> sectionOptions(SectionOptions& options) {
  std::vector<Option> all{{.name = "scene",
                           .target = &options.scene,
                           .value = "SCENE",
                           .help = "The scene file.",
                           .required = true},
                          {.name = "--time",
                           .target = &options.time,
                           .value = "S",
                           .help = "Simulated time, in s.",
                           .shownDefault = "0"}};
  for (Option& option : planeOptions(options.what, "")) all.push_back(std::move(option));
  const std::vector<Option> more{{.name = "--cells",
                                  .target = &options.cells,
                                  .value = "N",
                                  .help = "Along the longer side; of gamma_error 128, for it takes long.",
                                  .range = {{kFewestCells, kMostCells}},
                                  .shownDefault = std::to_string(kCellsAcross)},
                                 {.name = "--csv",
                                  .target = &options.csv,
                                  .value = "FILE",
                                  .help = "Writes the cells of the liquid as x,y,z,value."},
                                 {.name = "--png",
                                  .target = &options.png,
                                  .value = "FILE",
                                  .help = "Draws them with lines of equal values."}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace

Command sectionCommand() {
  return {"section", "Shows a field of the liquid on a plane, right up to the walls, as CSV and PNG.", [] {
            const auto options = std::make_shared<SectionOptions>();
            return Declaration{sectionOptions(*options), [options](const CommonOptions& common) {
                                 return runSection(*options, common);
                               }};
          }};
}

}  // namespace migiwa
