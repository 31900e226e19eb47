// The smoothing kernels a scene can name.
#pragma once

#include <array>
#include <string_view>

namespace migiwa {

enum class KernelType { poly6, spiky, cubicSpline, wendlandC2 };
inline constexpr std::array<std::string_view, 4> kKernelNames{"poly6", "spiky", "cubic_spline",
                                                              "wendland_c2"};

}  // namespace migiwa
