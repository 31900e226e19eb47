#include "core/solver/effect_pipeline.h"

#include <algorithm>

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

void EffectPipeline::changePrediction(StepState& state) {
  for (const NamedEffect& stage : prediction_)
    state.times.time(stage.name, [&] { stage.effect->changePrediction(state, buffers_); });
}

void EffectPipeline::changePositions(StepState& state, float weight) {
  for (const NamedEffect& stage : iteration_)
    state.times.time(stage.name, [&] { stage.effect->changePositions(state, weight); });
}

void EffectPipeline::changeVelocities(StepState& state) {
  for (const NamedEffect& stage : velocity_)
    state.times.time(stage.name, [&] { stage.effect->changeVelocities(state, buffers_); });
}

double EffectPipeline::longestStep(const StepState& state) const {
  double longest = std::numeric_limits<double>::infinity();
  for (const auto* stage : {&prediction_, &iteration_, &velocity_})
    for (const NamedEffect& named : *stage) longest = std::min(longest, named.effect->longestStep(state));
  return longest;
}

std::size_t EffectPipeline::bytes() const {
  std::size_t bytes = 0;
  for (const EffectBuffer& buffer : buffers_) bytes += buffer.capacity() * sizeof(Float4);
  return bytes;
}

}  // namespace migiwa
