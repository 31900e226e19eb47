// Runs without guards (core/solver/parameters.h) beside those with them, each by guard_probe.cpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hard_cases/hard_case.h"

namespace migiwa::testing {

/// What becomes of a case without guards, in a few words; `hash` is that of the run with them.
std::string withoutGuards(const HardCase& hardCase, std::uint64_t hash);

/// A run of a shipped scene.
struct NormalRun {
  std::uint64_t hash = 0;
  long frames = 0, steps = 0;
  double seconds = 0;  ///< of the processor, for its steps
};
/// A shipped scene that no guard may change.
struct NormalScene {
  std::string name;      ///< of its file
  double until;          ///< by when it has met its walls (s)
  std::string override;  ///< pointer=value, or empty
};
std::vector<NormalScene> normalScenes();
NormalRun normalRun(const NormalScene& scene, Guards guards);

/// Hash and speed of the normal scenes with and without guards, as a table.
std::string normalTable();

}  // namespace migiwa::testing
