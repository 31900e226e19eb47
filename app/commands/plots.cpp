#include "app/commands/plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <sstream>

#include "app/render/image.h"
#include "core/study/study.h"

namespace migiwa {

namespace {

/// "x (m)", or "x - 431250 (m)" where coordinates are relative to that.
std::string axisLabel(int axis, const Vec3d& origin) {
  std::ostringstream text;
  text.precision(12);
  text << "xyz"[axis];
  if (origin[axis] != 0) text << (origin[axis] > 0 ? " - " : " + ") << std::abs(origin[axis]);
  text << " (m)";
  return text.str();
}

}  // namespace

std::string sequentialPalette() {
  std::ostringstream out;
  out << "set palette defined (";
  constexpr std::size_t kStops = 15;
  const ColorMap colors = makeColorMap();
  for (std::size_t k = 0; k <= kStops; ++k) {
    const Rgb8& color = colors[k * (kColorMapSize - 1) / kStops];
    char hex[8];
    std::snprintf(hex, sizeof hex, "#%02x%02x%02x", static_cast<unsigned>(color[0]),
                  static_cast<unsigned>(color[1]), static_cast<unsigned>(color[2]));
    out << (k > 0 ? ", " : "") << k << " '" << hex << "'";
  }
  out << ")\n";
  return out.str();
}

namespace {

std::string panelData(const MapWindow& window, const MapPanel& panel, int number) {
  std::ostringstream out;
  out << "$map" << number << " << EOD\n";
  std::size_t at = 0;
  for (int row = 0; row < window.rows; ++row) {
    for (int column = 0; column < window.columns; ++column, ++at) {
      const Vec3d p = window.point(column, row);
      out << p[window.across] << ' ' << p[window.up] << ' ';
      if (std::isfinite(panel.values[at])) {
        out << panel.values[at] << '\n';
      } else {
        out << "NaN\n";
      }
    }
  }
  out << "EOD\n";
  return out.str();
}

}  // namespace

void plotMaps(const std::filesystem::path& png, const MapWindow& window, const Vec3d& origin,
              const std::vector<MapPanel>& panels, std::size_t perRow, double largestError) {
  const std::size_t columns = std::min(perRow, panels.size());
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  std::ostringstream script;
  for (std::size_t k = 0; k < panels.size(); ++k) script << panelData(window, panels[k], static_cast<int>(k));
  script << "set multiplot layout " << rows << ',' << columns << '\n'
         << "set size ratio -1\nset xlabel '" << axisLabel(window.across, origin)
         << "' offset 0,0.3\nset ylabel '" << axisLabel(window.up, origin) << "' offset 0.5,0\n"
         << "set xrange [" << window.low[0] << ':' << window.high[0] << "]\nset yrange [" << window.low[1]
         << ':' << window.high[1]
         << "]\nset xtics auto\nset tics out nomirror\nset object rectangle from graph 0,0 to graph "
            "1,1 behind fillcolor rgb '#c8ccd0' fillstyle solid noborder\n";
  for (std::size_t k = 0; k < panels.size(); ++k) {
    script << "set title '" << panels[k].title << "'\n";
    if (panels[k].error) {
      script
          << "set palette defined (-1 '#1d4f9c', -0.5 '#7fa7d8', 0 '#ffffff', 0.5 '#e2977f', 1 '#a8231f')\n"
          << "set cbrange [" << -largestError << ':' << largestError << "]\n";
    } else {
      script << sequentialPalette() << "set cbrange [0:1]\n";
    }
    script << "plot $map" << k << " using 1:2:3 with image notitle\n";
  }
  script << "unset multiplot\n";

  std::ostringstream terminal;
  terminal << "pngcairo size " << 470 * columns << ',' << 430 * rows << " font 'DejaVu Sans,11'";
  drawWithGnuplot(png, terminal.str(), script.str());
}

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

const char* lineColor(std::size_t k) {
  // Okabe and Ito's colours that stand out from white, then darker ones.
  static constexpr std::array<const char*, 8> kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                      "#8a6d00", "#56b4e9", "#5b3f8c", "#777777"};
  return kColors[k % kColors.size()];
}

std::string quotedForGnuplot(std::string text) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 2) text.insert(at, "'");
  return "'" + text + "'";
}

LogAxis::LogAxis(double least, double most, double below, double above) {
  const double decades = std::max(std::log10(most / least), 0.3);
  low = least * std::pow(10, -below * decades);
  high = most * std::pow(10, above * decades);
}

double LogAxis::part(double value) const {
  return std::log(value / low) / std::log(high / low);
}

std::string logTicks(const char* axis, const LogAxis& range) {
  const double span = range.high / range.low;
  if (span > 200) return {};
  std::ostringstream line;
  line << "set " << axis << "tics (";
  bool any = false;
  for (int decade = static_cast<int>(std::floor(std::log10(range.low))); decade <= std::log10(range.high);
       ++decade)
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0}) {
      const double at = digit * std::pow(10, decade);
      if (at < range.low || at > range.high) continue;
      if (span > 20 && digit != 1 && digit != 2 && digit != 5) continue;
      line << (any ? ", " : "") << at;
      any = true;
    }
  line << ")\n";
  return line.str();
}

}  // namespace migiwa
