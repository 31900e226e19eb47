// One line on a terminal that tells how far a run is: time, speed, time left. Nothing where there is no
// terminal.
#pragma once

#include <chrono>

namespace migiwa {

class ProgressBar {
 public:
  /// `from` and `until` are the simulated times (s) at the start and at the end. Silent when `quiet`, or when
  /// the standard error stream goes to a file.
  ProgressBar(double from, double until, bool quiet);
  /// Wipes the line, so that nothing of it stays between the messages around it.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `time` (s) is reached. Draws at most ten times a second.
  void update(double time);

 private:
  using Clock = std::chrono::steady_clock;

  double from_, until_;
  bool shown_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
};

}  // namespace migiwa
