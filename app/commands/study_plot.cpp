#include "app/commands/study_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "app/commands/gnuplot.h"
#include "app/commands/study_drawing.h"
#include "core/study/convergence.h"

namespace migiwa {

namespace {

struct Point {
  double cost, least, most, error;  ///< least and most: about the middle half of whole repetitions
  std::string note;                 ///< what tells it from the others of its line
};

struct Line {
  std::string label;
  std::vector<Point> points;
};

std::string noteOf(const StudyPlan& plan, const FinishedRun& run, std::size_t from) {
  std::string note;
  for (std::size_t k = from; k < plan.axes.size(); ++k)
    note += (k > from ? ", " : "") + plan.axes[k].label(run.values[k]);
  return note;
}

/// Wall time a simulated second (ms) that this part of the repetitions stays below.
double repetitionTime(const RunRecord& record, double part) {
  std::vector<double> times;
  for (const RunTiming& timing : record.timings) times.push_back(timing.wallMsPerSecond);
  std::sort(times.begin(), times.end());
  const double place = part * static_cast<double>(times.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, times.size() - 1);
  return std::lerp(times[below], times[above], place - static_cast<double>(below));
}

/// One line for each value of the first axis. A single axis of numbers is one line, of names a point each.
std::vector<Line> linesOf(const StudyPlan& plan, const std::vector<FinishedRun>& runs,
                          const AccuracyMeasure& measure) {
  const StudyAxis& first = plan.axes.front();
  const bool single = plan.axes.size() == 1 && isNumeric(first);
  std::vector<Line> lines(single ? 1 : first.values.size());
  for (std::size_t k = 0; k < lines.size(); ++k)
    lines[k].label = single ? first.name() : first.label(first.values[k]);
  for (const FinishedRun& run : runs) {
    const std::optional<double> error = measure.error(run.record);
    if (!error || *error <= 0) continue;
    const auto value = std::find(first.values.begin(), first.values.end(), run.values.front());
    Point point{runCost(run.record), 0, 0, *error, noteOf(plan, run, single ? 0 : 1)};
    point.least = std::min(point.cost, repetitionTime(run.record, 0.25));
    point.most = std::max(point.cost, repetitionTime(run.record, 0.75));
    lines[single ? 0 : static_cast<std::size_t>(value - first.values.begin())].points.push_back(point);
  }
  return lines;
}

/// Labels beside the dearest point of each line, pushed apart where they would lie on each other.
std::string labels(const std::vector<Line>& lines, const LogAxis& x, const LogAxis& y) {
  struct Label {
    double across, up;
    std::string text;
    std::size_t color;
  };
  std::vector<Label> all;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].points.empty()) continue;
    const Point& dearest = *std::max_element(lines[k].points.begin(), lines[k].points.end(),
                                             [](const Point& a, const Point& b) { return a.most < b.most; });
    all.push_back({x.part(dearest.most), y.part(dearest.error), lines[k].label, k});
  }
  std::sort(all.begin(), all.end(), [](const Label& a, const Label& b) { return a.up < b.up; });
  std::ostringstream out;
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t below = 0; below < k; ++below)
      if (std::abs(all[k].across - all[below].across) < 0.15)
        all[k].up = std::max(all[k].up, all[below].up + 0.04);
    out << "set label " << quotedForGnuplot(all[k].text) << " at graph " << all[k].across + 0.012 << ','
        << all[k].up << " left font 'DejaVu Sans Bold,13' textcolor rgb '" << lineColor(all[k].color)
        << "' front\n";
  }
  return out.str();
}

}  // namespace

bool plotStudy(const std::filesystem::path& png, const StudyPlan& plan, const std::vector<FinishedRun>& runs,
               const AccuracyMeasure& measure) {
  const std::vector<Line> lines = linesOf(plan, runs, measure);
  double cheapest = std::numeric_limits<double>::infinity(), dearest = 0, least = cheapest, most = 0;
  std::size_t shown = 0;
  for (const Line& line : lines) {
    for (const Point& point : line.points) {
      cheapest = std::min(cheapest, point.least), dearest = std::max(dearest, point.most);
      least = std::min(least, point.error), most = std::max(most, point.error);
      ++shown;
    }
  }
  if (shown == 0) return false;
  const LogAxis x(cheapest, dearest, 0.06, 0.2), y(least, most, 0.08, 0.1);

  std::ostringstream script;
  const auto block = [&](const std::string& name, const std::vector<Point>& points) {
    script << "$" << name << " << EOD\n";
    for (const Point& p : points)
      script << p.cost << ' ' << p.error << ' ' << p.least << ' ' << p.most << " \"" << p.note << "\"\n";
    script << "EOD\n";
  };
  for (std::size_t k = 0; k < lines.size(); ++k) block("line" + std::to_string(k), lines[k].points);
  std::vector<Point> front;
  for (const std::size_t at : frontOf(runs, measure)) {
    const double error = *measure.error(runs[at].record), cost = runCost(runs[at].record);
    if (error > 0) front.push_back({cost, cost, cost, error, ""});
  }
  block("front", front);

  std::string varied;
  for (const StudyAxis& axis : plan.axes) varied += (varied.empty() ? "" : ", ") + axis.name();
  std::ostringstream title;
  title << "What accuracy costs: " << plan.scene.stem().string() << ", " << plan.until << " s, by " << varied;
  if (shown < runs.size())
    title << "\\n" << runs.size() - shown << " of " << runs.size() << " runs have no error to show here";
  std::string titleText = title.str();
  for (std::size_t at = 0; (at = titleText.find('"', at)) != std::string::npos;) titleText[at] = '\'';
  script << "set title \"" << titleText << "\" font 'DejaVu Sans,15'\n"
         << "set logscale xy\nset xrange [" << x.low << ':' << x.high << "]\nset yrange [" << y.low << ':'
         << y.high << "]\nset xlabel 'wall time a simulated second (ms)'\nset ylabel "
         << quotedForGnuplot(measure.title + (measure.unit.empty() ? "" : " (" + measure.unit + ")"))
         << "\nset format x '%.6g'\nset format y '%.3g'\n"
         << "set xtics add auto\nset mxtics 10\nset grid xtics ytics mxtics mytics linecolor rgb '#d8d8d8', "
            "linecolor rgb '#ececec'\nset key bottom left box linecolor rgb '#bbbbbb' opaque\n";
  script << logTicks("x", x) << logTicks("y", y) << labels(lines, x, y) << "plot ";
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].points.empty()) continue;
    const std::string data = "$line" + std::to_string(k), color = lineColor(k);
    script << data << " using 1:2 with lines linewidth 2 linecolor rgb '" << color << "' notitle, " << data
           << " using 1:2:3:4 with xerrorbars pointtype 7 pointsize 1.1 linewidth 1 linecolor rgb '" << color
           << "' notitle, " << data
           << " using 1:2:5 with labels offset 0,0.8 font 'DejaVu Sans,10' textcolor rgb '" << color
           << "' notitle, ";
  }
  script << "$front using 1:2 with linespoints pointtype 6 pointsize 2.4 linewidth 1.5 dashtype 2 linecolor "
            "rgb 'black' title 'Pareto front: nothing is both faster and more exact'\n";
  drawWithGnuplot(png, "pngcairo noenhanced size 1280,800 font 'DejaVu Sans,13'", script.str());
  return true;
}

}  // namespace migiwa
