// What is read off a value over time: waves, means, peaks.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace migiwa {

/// A value over time, by rising times.
struct Series {
  std::vector<double> times, values;  ///< of the same length (s, any unit)

  bool empty() const { return times.empty(); }
};

/// A place where a series turns.
struct Turn {
  double time, value;
};

/// The start, and then the highest and lowest places between which the series goes to and fro by more than
/// `least`, in turns. Each is that of the parabola that fits the values about it best, so neither is bound to
/// the samples. What comes after the last one that is certain is none.
std::vector<Turn> turningPoints(const Series& series, double least);

/// What is kept of a wave, from its first turning point after the start on. With turning points v_1, v_2, ...
/// and heights H_k = |v_k - v_{k+1}|:
///   kept    mean of H_3/H_1, H_5/H_3 and H_7/H_5: the share of the height that is kept a period
///   period  (t_7 - t_1) / 3
/// With fewer turning points, over one period or two; null where there is none.
struct WaveMeasures {
  std::optional<double> kept, period;  ///< (1, s)
};
WaveMeasures waveMeasures(const Series& series);

/// Mean of the values from `begin` to `end` (s), both included; null where there is none.
std::optional<double> meanBetween(const Series& series, double begin, double end);

/// The value at `time` (s), between samples on the straight line; null before the first and after the last.
std::optional<double> valueAt(const Series& series, double time);

/// When the series first reaches `value`, from below, on the straight line between samples; null where it
/// does not.
std::optional<double> timeOf(const Series& series, double value);

/// The largest value from `begin` to `end` (s); null where there is none.
std::optional<Turn> peakBetween(const Series& series, double begin, double end);

}  // namespace migiwa
