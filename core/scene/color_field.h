// The particle quantities that pictures can be coloured by.
#pragma once

#include <array>
#include <string_view>

namespace migiwa {

enum class ColorField { density, speed, gamma, lambda, neighbours, pressure };
inline constexpr std::array<std::string_view, 6> kColorFieldNames{"density", "speed",      "gamma",
                                                                  "lambda",  "neighbours", "pressure"};

}  // namespace migiwa
