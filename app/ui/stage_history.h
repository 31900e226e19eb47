// Where the time of the last frames went: stages stacked over time.
#pragma once

#include <deque>

#include "core/base/stage_times.h"

namespace migiwa {

class StageHistory {
 public:
  static constexpr std::size_t kFrames = 240;

  /// Takes in a frame; one that has been taken in before (`steps` as before) counts once.
  void add(long steps, const StageTimes& times);
  const std::deque<StageTimes>& frames() const { return frames_; }

 private:
  std::deque<StageTimes> frames_;
  long steps_ = -1;
};

/// Milliseconds a frame over the last frames, in the colours of the stage bar. Fills the width of the current
/// ImGui window.
void stageChart(const StageHistory& history, float height);

}  // namespace migiwa
