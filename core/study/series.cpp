#include "core/study/series.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace migiwa {

namespace {

/// A wave that is lower than this part of the whole range is taken for noise.
constexpr double kNoise = 0.02;
/// The parabola at a turning point goes by so much of the time to the next one, to both sides.
constexpr double kAbout = 0.15;
/// Periods that a wave is measured over.
constexpr std::size_t kPeriods = 3;

/// The top of the parabola through the values within `reach` (s) of a turning point; itself where it has none
/// there.
Turn refined(const Series& series, const Turn& turn, double reach) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::size_t used = 0;
  for (std::size_t k = 0; k < series.times.size(); ++k) {
    const double x = (series.times[k] - turn.time) / reach;
    if (std::abs(x) > 1) continue;
    const Eigen::Vector3d powers(1, x, x * x);
    normal += powers * powers.transpose();
    right += powers * (series.values[k] - turn.value);
    ++used;
  }
  if (used < 5) return turn;
  const Eigen::Vector3d fit = normal.ldlt().solve(right);
  const double top = -0.5 * fit[1] / fit[2];
  if (!(std::abs(top) <= 1)) return turn;
  return {turn.time + reach * top, turn.value + fit[0] + 0.5 * fit[1] * top};
}

}  // namespace

std::vector<Turn> turningPoints(const Series& series, double least) {
  std::vector<Turn> turns;
  if (series.empty()) return turns;
  turns.push_back({series.times[0], series.values[0]});
  Turn highest = turns[0], lowest = turns[0];
  int going = 0;  // 1 up, -1 down
  for (std::size_t k = 1; k < series.times.size(); ++k) {
    const Turn now{series.times[k], series.values[k]};
    if (now.value > highest.value) highest = now;
    if (now.value < lowest.value) lowest = now;
    if (going >= 0 && highest.value - now.value > least) {
      if (going > 0) turns.push_back(highest);
      going = -1;
      lowest = now;
    } else if (going <= 0 && now.value - lowest.value > least) {
      if (going < 0) turns.push_back(lowest);
      going = 1;
      highest = now;
    }
  }
  const std::vector<Turn> found = turns;
  for (std::size_t k = 1; k < turns.size(); ++k)
    turns[k] = refined(series, found[k], kAbout * (found[k].time - found[k - 1].time));
  return turns;
}

WaveMeasures waveMeasures(const Series& series) {
  if (series.empty()) return {};
  const auto [low, high] = std::minmax_element(series.values.begin(), series.values.end());
  const std::vector<Turn> turns = turningPoints(series, kNoise * (*high - *low));
  const auto height = [&](std::size_t k) { return std::abs(turns[k].value - turns[k + 1].value); };
  double kept = 0;
  std::size_t periods = 0;
  for (std::size_t k = 1; periods < kPeriods && k + 3 < turns.size(); k += 2, ++periods)
    kept += height(k + 2) / height(k);
  if (periods == 0) return {};
  const auto count = static_cast<double>(periods);
  return {kept / count, (turns[1 + 2 * periods].time - turns[1].time) / count};
}

std::optional<double> meanBetween(const Series& series, double begin, double end) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < series.times.size(); ++k) {
    if (series.times[k] < begin || series.times[k] > end) continue;
    sum += series.values[k];
    ++count;
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

std::optional<double> valueAt(const Series& series, double time) {
  const auto next = std::lower_bound(series.times.begin(), series.times.end(), time);
  if (next == series.times.end()) return std::nullopt;
  const auto k = static_cast<std::size_t>(next - series.times.begin());
  if (*next == time) return series.values[k];
  if (k == 0) return std::nullopt;
  const double part = (time - series.times[k - 1]) / (series.times[k] - series.times[k - 1]);
  return series.values[k - 1] + part * (series.values[k] - series.values[k - 1]);
}

std::optional<double> timeOf(const Series& series, double value) {
  for (std::size_t k = 0; k < series.times.size(); ++k) {
    if (series.values[k] < value) continue;
    if (k == 0) return series.times[0];
    const double part = (value - series.values[k - 1]) / (series.values[k] - series.values[k - 1]);
    return series.times[k - 1] + part * (series.times[k] - series.times[k - 1]);
  }
  return std::nullopt;
}

std::optional<Turn> peakBetween(const Series& series, double begin, double end) {
  std::optional<Turn> peak;
  for (std::size_t k = 0; k < series.times.size(); ++k)
    if (series.times[k] >= begin && series.times[k] <= end && (!peak || series.values[k] > peak->value))
      peak = Turn{series.times[k], series.values[k]};
  return peak;
}

}  // namespace migiwa
