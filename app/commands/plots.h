// The pictures of `migiwa gamma`, `migiwa study` and `migiwa slim`: most are drawn by gnuplot.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "app/render/image.h"
#include "core/gamma/gamma_method.h"
#include "core/slim/fit.h"
#include "core/study/study.h"

namespace migiwa {

// Maps of gamma as a labelled picture, drawn by gnuplot.

struct MapPanel {
  std::string title;
  std::vector<float> values;  ///< row by row; NaN is left blank
  bool error = false;         ///< drawn about zero in two colours, else from 0 to 1
};

/// Writes the panels side by side, `perRow` in a row, with axes in metres and a colour bar each. Axes count
/// from `origin` (m), which the window is relative to, and say so. Throws MissingError when gnuplot is not
/// there.
void plotMaps(const std::filesystem::path& png, const MapWindow& window, const Vec3d& origin,
              const std::vector<MapPanel>& panels, std::size_t perRow, double largestError);

// A study's pictures: error against cost, by gnuplot.

/// One measure over the wall time a simulated second, both logarithmic: a line for each value of the first
/// varied pointer, the Pareto front marked. Runs without the measure, and those with an error of exactly 0,
/// have no place there; how many is said below the title. Throws MissingError without gnuplot. Draws nothing
/// and returns false where no run has a place.
bool plotStudy(const std::filesystem::path& png, const StudyPlan& plan, const std::vector<FinishedRun>& runs,
               const AccuracyMeasure& measure);

// What a study shows of the runs themselves rather than of one number for each: the pressure in the water
// over its depth against rho0 g z, and the energy that the solver has added over time against its bound,
// none.

/// pressure_profile.png and energy.png, one line for each value of the first varied pointer: of its last run
/// that has such a profile. Leaves out a picture that would be empty. Throws MissingError without gnuplot.
void plotProfiles(const std::filesystem::path& folder, const StudyPlan& plan,
                  const std::vector<FinishedRun>& runs);

// How a study's errors follow its settings that are numbers: pictures by gnuplot, and words.

/// Draws FOLDER/over_NAME.png for each axis along which an order can be measured: the mean density error over
/// its values and, where there is one, the error of the settled height, logarithmic, a line for each
/// combination of the other values with its order. Throws MissingError without gnuplot.
void plotConvergence(const std::filesystem::path& folder, const StudyPlan& plan,
                     const std::vector<FinishedRun>& runs);

/// The same orders as Markdown tables; empty where there is no such axis.
std::string convergenceSummary(const StudyPlan& plan, const std::vector<FinishedRun>& runs);

// What the pictures of a study have in common: colours, logarithmic axes, text for gnuplot.

/// The colour of the k-th line, for gnuplot.
const char* lineColor(std::size_t k);

/// The pictures' own colour map, as gnuplot's palette.
std::string sequentialPalette();

/// Text between single quotes of gnuplot.
std::string quotedForGnuplot(std::string text);

/// Logarithmic axis that leaves room around what it shows, as parts of that below and above.
struct LogAxis {
  double low, high;
  LogAxis(double least, double most, double below, double above);
  /// Where a value lies on the axis: 0 at its low end, 1 at its high end.
  double part(double value) const;
};

/// gnuplot's line that sets the ticks of axis "x" or "y": within one or two decades a logarithmic axis has
/// hardly one of its own. Empty for longer ranges.
std::string logTicks(const char* axis, const LogAxis& range);

// A study in words, as Markdown.

/// Text for a cell of a Markdown table, where bars end a cell.
std::string tableCell(const std::string& text);

/// Which runs are on the front of each measure, what the best accuracy costs, and how far times scatter.
std::string studySummary(const StudyPlan& plan, const std::vector<FinishedRun>& runs);

// What `migiwa slim` shows of a fit: on the left the surface, on the right the nodes that it is made of.

/// Needs no display. Throws MissingError where this machine has no EGL.
Image drawSlim(const SlimData& data, ThreadPool& pool);

// Pictures drawn by gnuplot.

/// Runs a script after `set terminal TERMINAL` and writes its picture to `png`, whole or not at all. Throws
/// MissingError when gnuplot is not there, with the package to install; when it fails, with what it said; and
/// when it is killed, with the signal. A picture that cannot be written is as in writeTextFile().
void drawWithGnuplot(const std::filesystem::path& png, const std::string& terminal,
                     const std::string& script);

}  // namespace migiwa
