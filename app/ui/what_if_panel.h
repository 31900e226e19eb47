// "What if": error and cost of the present state with other settings beside those of now, as points in one
// chart.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/simulation/simulation.h"

namespace migiwa {

/// One setting that was tried.
struct WhatIfPoint {
  std::string label;  ///< such as "gamma: product, at most 10 iterations, tolerance 0.01"
  double milliseconds = 0;
  double iterations = 0;
  std::optional<double> densityError, gammaError;  ///< against the reference, mean
  std::string trouble;                             ///< why it could not go on
};

struct WhatIfModel {
  Settings asked;  ///< what the form says
  bool ask = false, clear = false;
  bool busy = false;
  bool follows = true;              ///< the form has not been touched: it says what the run has
  std::string note;                 ///< what is going on
  std::vector<WhatIfPoint> points;  ///< the first is what the run has now
};

}  // namespace migiwa
