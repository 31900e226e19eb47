// The colour map against Oklab's definition: from sRGB bytes back to lightness, with the forward matrices
// only.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "app/render/image.h"

namespace migiwa {
namespace color_map_test {

struct Oklab {
  double lightness, a, b;
};

Oklab toOklab(const Rgb8& color) {
  std::array<double, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = color[i] / 255.0;
    linear[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  const auto [r, g, b] = linear;
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

TEST(ColorMapTest, LightnessIsLinear) {
  const ColorMap map = makeColorMap();
  for (std::size_t i = 0; i < map.size(); ++i) {
    const double expected = 0.32 + 0.60 * static_cast<double>(i) / 255;
    EXPECT_NEAR(toOklab(map[i]).lightness, expected, 0.0035) << "entry " << i;
  }
}

TEST(ColorMapTest, EqualStepsLookEquallyFarApart) {
  const ColorMap map = makeColorMap();
  const auto distance = [&](std::size_t i, std::size_t j) {
    const Oklab p = toOklab(map[i]), q = toOklab(map[j]);
    return std::hypot(p.lightness - q.lightness, p.a - q.a, p.b - q.b);
  };
  double least = 1, most = 0;
  for (std::size_t i = 0; i + 15 < map.size(); i += 15) {
    least = std::min(least, distance(i, i + 15));
    most = std::max(most, distance(i, i + 15));
  }
  EXPECT_LT(most / least, 1.15) << "eight bits alone make about a tenth";
}

TEST(ColorMapTest, RunsFromDarkBlueOverTealAndGreenToYellow) {
  const ColorMap map = makeColorMap();
  const auto hue = [&](std::size_t i) {
    const Oklab c = toOklab(map[i]);
    const double degrees = std::atan2(c.b, c.a) * 180 / 3.14159265358979;
    return degrees < 0 ? degrees + 360 : degrees;
  };
  EXPECT_NEAR(hue(0), 267, 4);
  EXPECT_NEAR(hue(96), 195, 6);
  EXPECT_NEAR(hue(160), 148, 6);
  EXPECT_NEAR(hue(255), 102, 4);
  for (std::size_t i = 8; i < map.size(); i += 8) EXPECT_LT(hue(i), hue(i - 8)) << "entry " << i;
}

TEST(ColorMapTest, WarmMapIsAsEvenAndNeverBlueOrGreen) {
  const ColorMap map = makeWarmColorMap();
  for (std::size_t i = 0; i < map.size(); ++i) {
    EXPECT_NEAR(toOklab(map[i]).lightness, 0.32 + 0.60 * static_cast<double>(i) / 255, 0.0035)
        << "entry " << i;
    EXPECT_GE(map[i][0], map[i][1]) << "entry " << i;
    if (i > 40) {
      EXPECT_GT(map[i][0], map[i][2]) << "entry " << i;
    }
  }
}

}  // namespace color_map_test
}  // namespace migiwa
