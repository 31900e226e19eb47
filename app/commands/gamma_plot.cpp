#include "app/commands/gamma_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "app/commands/gnuplot.h"
#include "app/render/color_map.h"

namespace migiwa {

namespace {

constexpr std::array<const char*, 3> kAxisLabels{"x (m)", "y (m)", "z (m)"};

/// The pictures' own colour map, as gnuplot's palette.
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

void plotMaps(const std::filesystem::path& png, const MapWindow& window, const std::vector<MapPanel>& panels,
              std::size_t perRow, double largestError) {
  const std::size_t columns = std::min(perRow, panels.size());
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  std::ostringstream script;
  for (std::size_t k = 0; k < panels.size(); ++k) script << panelData(window, panels[k], static_cast<int>(k));
  script << "set multiplot layout " << rows << ',' << columns << '\n'
         << "set size ratio -1\nset xlabel '" << kAxisLabels.at(static_cast<std::size_t>(window.across))
         << "' offset 0,0.3\nset ylabel '" << kAxisLabels.at(static_cast<std::size_t>(window.up))
         << "' offset 0.5,0\n"
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

}  // namespace migiwa
