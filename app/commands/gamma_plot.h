// Maps of gamma as a labelled picture, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/boundary/gamma_map.h"

namespace migiwa {

struct MapPanel {
  std::string title;
  std::vector<float> values;  ///< row by row; NaN is left blank
  bool error = false;         ///< drawn about zero in two colours, else from 0 to 1
};

/// Writes the panels side by side, `perRow` in a row, with axes in metres and a colour bar each. Throws
/// MissingError when gnuplot is not there.
void plotMaps(const std::filesystem::path& png, const MapWindow& window, const std::vector<MapPanel>& panels,
              std::size_t perRow, double largestError);

}  // namespace migiwa
