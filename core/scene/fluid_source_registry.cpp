#include <array>

#include "core/scene/box_source.h"
#include "core/scene/sphere_source.h"

namespace migiwa {

namespace {

constexpr std::array<std::string_view, 2> kShapes{"box", "sphere"};
constexpr std::array<std::unique_ptr<FluidSource> (*)(), kShapes.size()> kMakers{
    []() -> std::unique_ptr<FluidSource> { return std::make_unique<BoxSource>(); },
    []() -> std::unique_ptr<FluidSource> { return std::make_unique<SphereSource>(); },
};

}  // namespace

std::span<const std::string_view> fluidShapes() {
  return kShapes;
}

std::unique_ptr<FluidSource> makeFluidSource(int shape) {
  return kMakers.at(static_cast<std::size_t>(shape))();
}

}  // namespace migiwa
