#include "core/simulation/run.h"

#include <cmath>

namespace migiwa {

SettledMeasures runUntil(Simulation& simulation, double until, const std::function<bool()>& eachFrame) {
  SettledSampler sampler;
  return runUntil(simulation, until, sampler, eachFrame);
}

SettledMeasures runUntil(Simulation& simulation, double until, SettledSampler& sampler,
                         const std::function<bool()>& eachFrame) {
  const long last = simulation.frameAt(until);
  const long firstSampled = static_cast<long>(std::floor(0.9 * static_cast<double>(last)));
  // Samples of neighbouring frames hardly differ: some fifty of them say what all would.
  const long stride = std::max(1L, (last - firstSampled) / 50);
  sampler.beginRun(last);
  while (simulation.frame() < last && !simulation.stopped()) {
    simulation.advanceFrame();
    const long frame = simulation.frame();
    if (frame > firstSampled && (last - frame) % stride == 0) sampler.sample(simulation);
    if (eachFrame && !eachFrame()) break;
  }
  return sampler.result();
}

}  // namespace migiwa
