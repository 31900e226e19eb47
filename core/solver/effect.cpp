#include <algorithm>
#include <cmath>
#include <utility>

#include "core/solver/step.h"

namespace migiwa {

EffectPipeline::EffectPipeline(const std::vector<NamedEffect>& effects) {
  std::size_t buffers = 0;
  for (const NamedEffect& named : effects) {
    const EffectStages stages = named.effect->stages();
    if (stages.prediction) prediction_.push_back(named);
    if (stages.iteration) iteration_.push_back(named);
    if (stages.velocity) velocity_.push_back(named);
    buffers = std::max(buffers, named.effect->buffers());
  }
  buffers_.resize(buffers);
}

namespace {

/// Runs each of the stages, and books what they change of an energy as the effects' work.
template <class Energy, class Run>
void runStages(StepState& state, const std::vector<NamedEffect>& stages, const Energy& energy, const Run& run,
               const EffectPipeline::Watch& watch) {
  if (stages.empty()) return;
  state.times.time(stages.front().name, [&] { state.effectWork -= energy(state); });
  for (const NamedEffect& stage : stages) {
    state.times.time(stage.name, [&] { run(*stage.effect); });
    if (watch) watch(stage.name);
  }
  state.times.time(stages.back().name, [&] { state.effectWork += energy(state); });
}

}  // namespace

void EffectPipeline::changePrediction(StepState& state, const Watch& watch) {
  runStages(
      state, prediction_, predictedEnergy,
      [&](const Effect& effect) { effect.changePrediction(state, buffers_); }, watch);
}

void EffectPipeline::changePositions(StepState& state, float weight, const Watch& watch) {
  runStages(
      state, iteration_, predictedEnergy,
      [&](const Effect& effect) { effect.changePositions(state, weight); }, watch);
}

bool EffectPipeline::changeVelocities(StepState& state, const Watch& watch) {
  // A single velocity that is not finite makes the work so: no pass of its own has to look for one.
  const double before = std::exchange(state.effectWork, 0);
  runStages(
      state, velocity_, velocityEnergy,
      [&](const Effect& effect) { effect.changeVelocities(state, buffers_); }, watch);
  const bool finite = std::isfinite(state.effectWork);
  state.velocityEffectWork = state.effectWork;
  state.effectWork += before;
  return finite;
}

double EffectPipeline::longestStep(const StepState& state) const {
  double longest = std::numeric_limits<double>::infinity();
  for (const auto* stage : {&prediction_, &iteration_, &velocity_})
    for (const NamedEffect& named : *stage) longest = std::min(longest, named.effect->longestStep(state));
  return longest;
}

}  // namespace migiwa
