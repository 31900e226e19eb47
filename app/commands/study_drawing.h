// What the pictures of a study have in common: colours, logarithmic axes, text for gnuplot.
#pragma once

#include <cstddef>
#include <string>

namespace migiwa {

/// The colour of the k-th line, for gnuplot.
const char* lineColor(std::size_t k);

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

}  // namespace migiwa
