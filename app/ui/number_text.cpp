#include "app/ui/number_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace migiwa {

std::string formatNumber(const char* format, double value) {
  char text[64];
  const int length = std::snprintf(text, sizeof(text), format, value);
  return std::string(text,
                     static_cast<std::size_t>(std::clamp(length, 0, static_cast<int>(sizeof(text)) - 1)));
}

std::string groupedDigits(std::size_t value) {
  std::string text = std::to_string(value);
  for (std::size_t place = text.size(); place > 3;) text.insert(place -= 3, ",");
  return text;
}

std::string milliseconds(double seconds, bool shown) {
  if (!shown) return "–";
  const double ms = 1e3 * seconds;
  return formatNumber(ms < 9.995 ? "%.2f" : ms < 99.95 ? "%.1f" : "%.0f", ms);
}

Ticks roundTicks(double low, double high, int wanted) {
  if (!(high > low) || !std::isfinite(high - low)) return {};
  const double rough = (high - low) / std::max(wanted - 1, 1);
  const double exponent = std::floor(std::log10(rough));
  const double digits = rough / std::pow(10, exponent);
  const double step = (digits < 1.5 ? 1 : digits < 3.5 ? 2 : digits < 7.5 ? 5 : 10) * std::pow(10, exponent);
  Ticks ticks;
  ticks.decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  const double slack = 1e-6 * step;
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; ++k) {
    ticks.values.push_back(k == 0 ? 0 : k * step);
  }
  return ticks;
}

}  // namespace migiwa
