// What is read off series against waves whose decay and period are known.
#include "core/study/series.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace migiwa {
namespace series_test {

/// 2 + cos(2 pi t / period) times kept^(t / period), every `step` (s), and some ripple.
Series wave(double period, double kept, double step, double until, double ripple = 0) {
  Series series;
  for (int k = 0; k * step <= until; ++k) {
    const double t = k * step;
    series.times.push_back(t);
    series.values.push_back(2 + std::pow(kept, t / period) * std::cos(2 * std::numbers::pi * t / period) +
                            ripple * std::sin(40 * t));
  }
  return series;
}

TEST(WaveMeasures, OfADecayingCosine) {
  for (const double kept : {1.0, 0.8, 0.5}) {
    const WaveMeasures found = waveMeasures(wave(1.18, kept, 0.005, 6));
    EXPECT_NEAR(*found.kept, kept, 2e-4);
    EXPECT_NEAR(*found.period, 1.18, 2e-4);
  }
}

TEST(WaveMeasures, ACoarseOrRippledSeriesChangesLittle) {
  EXPECT_NEAR(*waveMeasures(wave(1.18, 0.7, 0.05, 6)).kept, 0.7, 0.01);
  const WaveMeasures rippled = waveMeasures(wave(1.18, 0.7, 0.005, 6, 0.005));
  EXPECT_NEAR(*rippled.kept, 0.7, 0.02);
  EXPECT_NEAR(*rippled.period, 1.18, 0.01);
}

TEST(WaveMeasures, AShortSeriesHasFewerPeriodsOrNone) {
  EXPECT_NEAR(*waveMeasures(wave(1.18, 0.6, 0.005, 3)).kept, 0.6, 1e-3);
  EXPECT_FALSE(waveMeasures(wave(1.18, 0.6, 0.005, 1)).kept);
  EXPECT_FALSE(waveMeasures({}).kept);
  EXPECT_FALSE(waveMeasures({{0, 1, 2}, {5, 5, 5}}).period);
}

TEST(Series, IsReadBetweenItsSamples) {
  const Series series{{0, 1, 2, 3}, {0, 2, 6, 4}};
  EXPECT_DOUBLE_EQ(*valueAt(series, 1.5), 4);
  EXPECT_DOUBLE_EQ(*valueAt(series, 3), 4);
  EXPECT_FALSE(valueAt(series, 3.1));
  EXPECT_DOUBLE_EQ(*timeOf(series, 3), 1.25);
  EXPECT_FALSE(timeOf(series, 7));
  EXPECT_DOUBLE_EQ(*meanBetween(series, 1, 2), 4);
  EXPECT_FALSE(meanBetween(series, 4, 5));
  EXPECT_DOUBLE_EQ(peakBetween(series, 0, 3)->time, 2);
}

}  // namespace series_test
}  // namespace migiwa
