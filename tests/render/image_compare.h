// Pictures against golden ones.
#pragma once

#include <filesystem>
#include <optional>

#include "app/render/image.h"

namespace migiwa {

/// A channel may be off by so much before its pixel counts as different.
inline constexpr int kTolerance = 8;
/// The share of pixels that may be different.
inline constexpr double kAllowedShare = 0.01;

/// The share of pixels that differ by more than kTolerance in a channel; 1 for different sizes.
double differentShare(const Image& a, const Image& b);
/// Grey where they agree, red where they differ.
Image differencePicture(const Image& expected, const Image& found);

}  // namespace migiwa
