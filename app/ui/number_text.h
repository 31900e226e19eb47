// Numbers as a person reads them; independent of the locale.
#pragma once

#include <string>
#include <vector>

namespace migiwa {

/// printf's format with one number.
std::string formatNumber(const char* format, double value);
/// With a comma between groups of three digits.
std::string groupedDigits(std::size_t value);
/// Wall time in milliseconds with three digits that mean something, or a dash where times are not to be
/// shown.
std::string milliseconds(double seconds, bool shown);

/// Round numbers in [low, high], about `wanted` of them, with the digits that tell them apart.
struct Ticks {
  std::vector<double> values;
  int decimals = 0;
};
Ticks roundTicks(double low, double high, int wanted);

}  // namespace migiwa
