// What may change between two steps of a running simulation.
#pragma once

#include <filesystem>
#include <vector>

#include "core/effects/effect.h"
#include "core/solver/parameters.h"

namespace migiwa {

struct Settings {
  SolverParameters solver;
  BoundaryParameters boundary;
  std::vector<NamedEffect> effects;
};

/// Throws InputError where these settings of the scene file `scene` name a method for gamma that is only
/// there to compare with: no simulation can use it in every step.
void requireSteppable(const BoundaryParameters& boundary, const std::filesystem::path& scene);

}  // namespace migiwa
