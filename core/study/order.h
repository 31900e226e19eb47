// The order of convergence that a study measures.
#pragma once

#include <optional>
#include <span>

namespace migiwa {

struct ValueAndError {
  double value, error;  ///< takes part only where both are positive
};

/// The power of the value that the error follows: the slope of ln error over ln value, by least squares. Null
/// for fewer than three values.
std::optional<double> measuredOrder(std::span<const ValueAndError> points);

}  // namespace migiwa
