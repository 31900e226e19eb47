// What the effects of a scene add to a step: a list for each place where effects act, and the memory that
// they share. A scene without effects has empty lists and no memory.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "core/effects/effect.h"
#include "core/solver/step_state.h"

namespace migiwa {

class EffectPipeline {
 public:
  EffectPipeline() = default;
  explicit EffectPipeline(const std::vector<NamedEffect>& effects);

  /// Called with an effect's name after it has acted; empty: nobody watches.
  using Watch = std::function<void(std::string_view)>;

  // Each effect's time is booked under its name.
  void changePrediction(StepState& state, const Watch& watch = {});
  void changePositions(StepState& state, float weight, const Watch& watch = {});
  /// False where it leaves a velocity that is not finite, or that is too large for its square to be.
  bool changeVelocities(StepState& state, const Watch& watch = {});

  /// The longest step (s) over which all of them are stable.
  double longestStep(const StepState& state) const;

 private:
  std::vector<NamedEffect> prediction_, iteration_, velocity_;
  std::vector<EffectBuffer> buffers_;
};

}  // namespace migiwa
