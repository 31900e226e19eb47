// Our colour maps. Of particles: dark blue, teal, green, yellow. Built in Oklab (Ottosson 2020) so that equal
// steps of the value look equally far apart: lightness rises linearly, and the path through the colour plane
// is walked at constant speed. Of SLIM nodes: the same from plum over red and orange to a pale yellow, so
// that it is never taken for the particles'.
#pragma once

#include <array>
#include <cstdint>

namespace migiwa {

inline constexpr int kColorMapSize = 256;
using Rgb8 = std::array<std::uint8_t, 3>;
/// sRGB-encoded colours from the low end to the high end.
using ColorMap = std::array<Rgb8, kColorMapSize>;

/// Oklab lightness of the two ends.
inline constexpr double kColorMapDarkest = 0.32;
inline constexpr double kColorMapLightest = 0.92;

ColorMap makeColorMap();
ColorMap makeWarmColorMap();

}  // namespace migiwa
