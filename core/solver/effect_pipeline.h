// What the effects of a scene add to a step: a list for each place where effects act, and the memory that
// they share. A scene without effects has empty lists and no memory.
#pragma once

#include <vector>

#include "core/effects/effect.h"
#include "core/solver/step_state.h"

namespace migiwa {

class EffectPipeline {
 public:
  EffectPipeline() = default;
  explicit EffectPipeline(const std::vector<NamedEffect>& effects);

  // Each effect's time is booked under its name.
  void changePrediction(StepState& state);
  void changePositions(StepState& state, float weight);
  void changeVelocities(StepState& state);

  /// The longest step (s) over which all of them are stable.
  double longestStep(const StepState& state) const;

  /// Memory of the effects' own (bytes).
  std::size_t bytes() const;

 private:
  std::vector<NamedEffect> prediction_, iteration_, velocity_;
  std::vector<EffectBuffer> buffers_;
};

}  // namespace migiwa
