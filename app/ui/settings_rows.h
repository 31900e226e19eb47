// Rows of settings that several panels have. Each returns whether the user changed something.
#pragma once

#include "core/scene/scene.h"

namespace migiwa {

/// How walls are handled, and the method of gamma.
bool wallRows(BoundaryParameters& boundary);
bool maxIterationsRow(SolverParameters& solver);
bool toleranceRow(SolverParameters& solver);

}  // namespace migiwa
