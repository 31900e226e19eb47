#include "core/study/order.h"

#include <cmath>
#include <set>

namespace migiwa {

std::optional<double> measuredOrder(std::span<const ValueAndError> points) {
  double count = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  std::set<double> values;
  for (const auto& [value, error] : points) {
    if (!(value > 0 && error > 0)) continue;
    const double x = std::log(value), y = std::log(error);
    count += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    values.insert(value);
  }
  if (values.size() < 3) return std::nullopt;
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

}  // namespace migiwa
