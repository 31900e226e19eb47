// `migiwa section SCENE`: a field of the liquid on a plane, as CSV and as a picture.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include "app/commands/command.h"
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
  std::string scene, plane, normal, field{kSectionFieldNames[0]}, divisor{kSectionDivisorNames[0]}, csv, png;
  std::optional<double> offset, time;
  std::optional<int> cells;
};

constexpr int kCellsAcross = 512, kFewestCells = 2, kMostCells = 4096;
constexpr int kErrorCells = 128;  ///< of the error of gamma, which takes long

template <std::size_t N>
std::size_t indexIn(const std::array<std::string_view, N>& names, const std::string& name,
                    const char* option) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw InputError(option, "expected one of " + quotedList(names) + ", found \"" + name + "\"");
  return static_cast<std::size_t>(at - names.begin());
}

/// Numbers with commas between them; false where the text is anything else.
bool readNumbers(std::string_view text, std::span<double> numbers) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto [next, error] = std::from_chars(at, end, numbers[k]);
    if (error != std::errc() || !kCoordinateRange.contains(numbers[k])) return false;
    if (k + 1 == numbers.size()) return next == end;
    if (next == end || *next != ',') return false;
    at = next + 1;
  }
  return false;
}

/// A plane in the coordinates of the scene's file, and how it is called.
struct Cut {
  Vec3d normal = Vec3d::UnitZ();
  double offset = 0;  ///< along the unit normal (m)
  std::string name;
};

Cut cutOf(const SectionOptions& options, const Scene& scene) {
  Cut cut;
  std::ostringstream name;
  name.precision(6);
  if (!options.normal.empty()) {
    std::array<double, 3> normal{};
    const bool valid = readNumbers(options.normal, normal);
    cut.normal = Vec3d(normal[0], normal[1], normal[2]);
    if (!valid || !(cut.normal.norm() > 1e-9))
      throw InputError("--normal", "expected X,Y,Z of some length, found \"" + options.normal + "\"");
    cut.normal.normalize();
    cut.offset = options.offset ? *options.offset : cut.normal.dot(scene.bounds().center() + scene.origin);
    name << "(" << cut.normal.x() << ", " << cut.normal.y() << ", " << cut.normal.z()
         << ") · x = " << cut.offset << " m";
    cut.name = name.str();
    return cut;
  }
  if (options.offset) throw InputError("--offset", "expected --normal beside it, found none");
  std::size_t axis = static_cast<std::size_t>(scene.view.clip.axis);
  std::array<double, 1> at{};
  if (options.plane.empty()) {
    const auto k = static_cast<Eigen::Index>(axis);
    at[0] = scene.origin[k] + (scene.view.clip.enabled ? scene.view.clip.at : scene.bounds().center()[k]);
  } else {
    axis = std::min<std::size_t>(std::string_view("xyz").find(options.plane[0]), 3);
    if (axis == 3 || options.plane.size() < 3 || options.plane[1] != '=' ||
        !readNumbers(std::string_view(options.plane).substr(2), at))
      throw InputError("--plane", "expected an axis and a place on it in m such as x=0.5, found \"" +
                                      options.plane + "\"");
  }
  cut.normal = Vec3d::Unit(static_cast<Eigen::Index>(axis));
  cut.offset = at[0];
  name << "xyz"[axis] << " = " << at[0] << " m";
  cut.name = name.str();
  return cut;
}

struct SectionJob {
  Cut cut;
  SectionPlane plane;
  SectionField field;
  SectionDivisor divisor;
  double time;
};

SectionJob checkedJob(const SectionOptions& options, const Scene& scene) {
  SectionJob job;
  FaultCollector collect;
  collect(
      [&] { job.field = static_cast<SectionField>(indexIn(kSectionFieldNames, options.field, "--field")); });
  collect([&] {
    job.divisor = static_cast<SectionDivisor>(indexIn(kSectionDivisorNames, options.divisor, "--divisor"));
  });
  collect([&] {
    if (options.csv.empty() && options.png.empty())
      throw InputError("section", "expected --csv FILE or --png FILE, found neither");
    if (!options.csv.empty()) requireWritable(options.csv, "--csv");
    if (!options.png.empty()) requireWritable(options.png, "--png");
  });
  collect([&] {
    job.time = options.time.value_or(0);
    if (!(job.time >= 0 && job.time <= kLongestRun))
      throw InputError("--time",
                       "expected a time in [0, 1e+06] (unit: s), found " + formatNumber("%g", job.time));
  });
  collect([&] {
    if (scene.bounds().empty())
      throw InputError(options.scene, "expected fluid or walls of some extent to cut through, found neither");
    job.cut = cutOf(options, scene);
    const int cells =
        options.cells.value_or(job.field == SectionField::gammaError ? kErrorCells : kCellsAcross);
    const Vec3d up = scene.gravity.norm() > 0 ? Vec3d(-scene.gravity) : scene.view.camera.up;
    const auto plane = sectionPlane(job.cut.normal, job.cut.offset - job.cut.normal.dot(scene.origin),
                                    scene.bounds(), up, cells);
    if (!plane) {
      const Bounds bounds = scene.bounds();
      std::ostringstream text;
      text << "expected a plane that meets the scene, which reaches from ("
           << (bounds.min + scene.origin).transpose() << ") to (" << (bounds.max + scene.origin).transpose()
           << ") m, found " << job.cut.name;
      throw InputError(options.normal.empty() ? "--plane" : "--offset", text.str());
    }
    job.plane = *plane;
  });
  collect.raise();
  return job;
}

/// What is along an axis of the picture.
std::string axisName(const Vec3d& along) {
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    if (along[axis] > 1 - 1e-9) return std::string(1, "xyz"[axis]) + " (m)";
  std::ostringstream text;
  text.precision(2);
  text << "along (" << along.x() << ", " << along.y() << ", " << along.z() << ") (m)";
  return text.str();
}

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
  // Places along the axes of the picture, in the coordinates of the scene's file.
  const double left = (plane.corner + scene.origin).dot(plane.across),
               bottom = (plane.corner + scene.origin).dot(plane.up);
  const double right = left + plane.columns * plane.cell, top = bottom + plane.rows * plane.cell;
  std::ostringstream script;
  script << "$map << EOD\n";
  std::size_t k = 0;
  for (int row = 0; row < plane.rows; ++row) {
    for (int column = 0; column < plane.columns; ++column, ++k) {
      script << left + (column + 0.5) * plane.cell << ' ' << bottom + (row + 0.5) * plane.cell << ' ';
      if (std::isnan(raster.values[k])) {
        script << "NaN\n";
      } else {
        script << raster.values[k] << '\n';
      }
    }
    script << '\n';
  }
  script << "EOD\n" << sequentialPalette() << "set cbrange [" << info.low << ':' << info.high << "]\n";
  const Ticks ticks = roundTicks(info.low, info.high, 12);
  script << "set contour base\nset cntrparam levels discrete ";
  for (std::size_t n = 0; n < ticks.values.size(); ++n) script << (n > 0 ? "," : "") << ticks.values[n];
  // Within one colour there is nothing to tell apart by lines: they would trace what is left of rounding.
  script
      << "\nunset surface\nset table $lines\nsplot $map using 1:2:3 with lines\nunset table\n"
      << "set size ratio -1\nset xlabel " << quotedForGnuplot(axisName(plane.across)) << "\nset ylabel "
      << quotedForGnuplot(axisName(plane.up)) << "\nset xrange [" << left << ':' << right << "]\nset yrange ["
      << bottom << ':' << top << "]\nset tics out nomirror\nset cblabel "
      << quotedForGnuplot(info.label + (info.unit.empty() ? "" : " (" + info.unit + ")")) << "\nset title "
      << quotedForGnuplot(title)
      << "\nset object rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb '#e4e7ea' fillstyle solid "
         "noborder\nplot $map using 1:2:3 with image notitle, $lines using 1:2 with lines linewidth 0.8 "
         "linecolor rgb '#30000000' notitle\n";
  const double shape = (top - bottom) / (right - left);
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
  return {
      {.name = "scene",
       .target = &options.scene,
       .value = "SCENE",
       .help = "The scene file.",
       .required = true},
      {.name = "--time",
       .target = &options.time,
       .value = "S",
       .help = "Simulated time, in s.",
       .shownDefault = "0"},
      {.name = "--plane",
       .target = &options.plane,
       .value = "AXIS=M",
       .help = "Such as x=0.5, in m; left out: the scene's cut, or its middle."},
      {.name = "--normal",
       .target = &options.normal,
       .value = "X,Y,Z",
       .help = "A plane at an angle, by its normal, instead.",
       .excludes = {"--plane"}},
      {.name = "--offset",
       .target = &options.offset,
       .value = "M",
       .help = "How far along the unit normal it lies from the origin, in m; left out: through the middle."},
      {.name = "--field",
       .target = &options.field,
       .value = "NAME",
       .help = "density, pressure, speed, gamma, or gamma_error: gamma less its reference.",
       .shownDefault = "density"},
      {.name = "--divisor",
       .target = &options.divisor,
       .value = "sum|gamma|none",
       .help = "What the sum over the particles is divided by: the sum of the kernel, gamma, or nothing.",
       .shownDefault = "sum"},
      {.name = "--cells",
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
