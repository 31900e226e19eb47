#include "core/solver/pressure.h"

#include "core/solver/step_state.h"

namespace migiwa {

void PressureSum::watch(bool on) {
  if (on == watched_) return;
  watched_ = on;
  clear();
}

void PressureSum::clear() {
  now_.clear();
  before_.clear();
}

void PressureSum::begin(const StepState& state) {
  if (!watched_) return;
  now_.assign(state.particles.size(), 0);
  before_.assign(state.particles.size(), 0);
}

void PressureSum::iterate(const StepState& state, float weight) {
  if (!watched_) return;
  parallelFor(state.pool, now_.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) before_[i] += weight * (now_[i] + state.lambda[i] - before_[i]);
  });
  now_.swap(before_);
}

void PressureSum::pressures(const StepState& state, std::vector<float>& out) const {
  out.resize(now_.size());
  const double scale = -state.parameters.restDensity * static_cast<double>(state.supportRadius) *
                       static_cast<double>(state.supportRadius) /
                       (static_cast<double>(state.timeStep) * static_cast<double>(state.timeStep));
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<float>(scale * static_cast<double>(now_[i]));
}

}  // namespace migiwa
