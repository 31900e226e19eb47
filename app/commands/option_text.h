// Option values that are lists or pairs, read from their text. Faults name the option.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_reader.h"

namespace migiwa {

/// `0,0.5,1`: times in s, sorted, each once. Throws InputError.
std::vector<double> parseTimes(const std::string& text, std::string_view option);
/// `1280x720`: width and height in pixels. Throws InputError.
std::array<int, 2> parseSize(const std::string& text, std::string_view option);
/// `/json/pointer=a,b,c`: one override for each value; commas inside brackets and quotes part nothing. Throws
/// InputError.
std::vector<Override> parseVariants(const std::string& text, std::string_view option);

}  // namespace migiwa
