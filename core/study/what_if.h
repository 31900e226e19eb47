// "What if": the present state of a run goes on for a few frames with other settings, on a copy, and is
// judged by the reference that all methods share. What it says is of these frames alone: a method that lets
// water crowd a wall over seconds shows little of that in five frames.
#pragma once

#include <memory>

#include "core/simulation/simulation.h"
#include "core/simulation/state_image.h"
#include "core/study/reference_errors.h"

namespace migiwa {

struct WhatIfAnswer {
  double time = 0;         ///< of the state that was asked about (s)
  double stepSeconds = 0;  ///< wall time of a substep (s): the median over the frames but the first
  double iterations = 0;   ///< of a substep, mean
  double solverError = 0;  ///< mean density error that the run itself sees after the last substep
  ReferenceErrors errors;  ///< of the last frame's state
  std::string handling;    ///< how walls were handled, such as "gamma: product"
  std::string trouble;     ///< why it had to stop; empty: it did not
};

class WhatIf {
 public:
  /// The first frame after a change of settings evaluates gamma of all particles anew and does not count.
  static constexpr int kFrames = 5;

  /// Fills the scene and prepares its walls anew, which may take seconds. `threads` as for a Simulation.
  WhatIf(const Scene& scene, int threads);

  /// The scene that `state` was taken from must be this one.
  WhatIfAnswer ask(const StateImage& state, const Settings& settings);

 private:
  Simulation copy_;
};

}  // namespace migiwa
