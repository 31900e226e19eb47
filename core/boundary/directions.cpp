#include "core/boundary/directions.h"

#include <cmath>
#include <numbers>

#include "core/base/portable_math.h"

namespace migiwa {

Directions fibonacciDirections(int count) {
  Directions set;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2.0 * k + 1) / count;
    const double radius = std::sqrt(1 - z * z);
    set.x.push_back(static_cast<float>(radius * portable::cos(golden * k)));
    set.y.push_back(static_cast<float>(radius * portable::sin(golden * k)));
    set.z.push_back(static_cast<float>(z));
  }
  return set;
}

}  // namespace migiwa
