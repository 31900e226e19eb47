#include "app/commands/study_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace migiwa {

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
