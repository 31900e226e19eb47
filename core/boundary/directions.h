// A fixed set of unit vectors spread evenly over the sphere, coordinate by coordinate so that loops over it
// vectorise.
#pragma once

#include <vector>

#include "core/base/types.h"

namespace migiwa {

struct Directions {
  std::vector<float> x, y, z;
  std::size_t size() const { return x.size(); }
};

/// A Fibonacci set: `count` points on a spiral, equal areas to each.
Directions fibonacciDirections(int count);

}  // namespace migiwa
