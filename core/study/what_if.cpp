#include "core/study/what_if.h"

#include <algorithm>
#include <vector>

namespace migiwa {

WhatIf::WhatIf(const Scene& scene, int threads) : copy_(scene, threads) {}

WhatIfAnswer WhatIf::ask(const StateImage& state, const Settings& settings) {
  state.restore(copy_);
  copy_.apply(settings);
  WhatIfAnswer answer;
  answer.time = copy_.time();
  const RunStatistics& statistics = copy_.statistics();
  const long stepsBefore = statistics.steps;
  const double iterationsBefore = statistics.iterationSum;
  std::size_t counted = statistics.stepSeconds.size();
  for (int frame = 0; frame < kFrames && !copy_.stopped(); ++frame) {
    copy_.advanceFrame();
    if (frame == 0) counted = statistics.stepSeconds.size();
  }

  std::vector<float> seconds(statistics.stepSeconds.begin() + static_cast<std::ptrdiff_t>(counted),
                             statistics.stepSeconds.end());
  if (!seconds.empty()) {
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    answer.stepSeconds = static_cast<double>(*middle);
  }
  if (const long steps = statistics.steps - stepsBefore; steps > 0)
    answer.iterations = (statistics.iterationSum - iterationsBefore) / static_cast<double>(steps);
  const FrameInfo& info = copy_.view().info;
  answer.handling = info.handling;
  if (!info.errors.empty()) answer.solverError = info.errors.back().mean;
  if (statistics.failed() && !statistics.trouble.empty())
    answer.trouble = statistics.trouble.back().kind + ": " + statistics.trouble.back().detail;
  ReferenceSampler sampler(copy_.threads());
  sampler.sample(copy_);
  answer.errors = sampler.result();
  return answer;
}

}  // namespace migiwa
