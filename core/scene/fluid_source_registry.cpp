#include <array>

#include "core/base/registry.h"
#include "core/scene/box_source.h"
#include "core/scene/mesh_source.h"
#include "core/scene/sphere_source.h"

namespace migiwa {

namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<FluidSource> (*make)();
};

template <class Source>
std::unique_ptr<FluidSource> make() {
  return std::make_unique<Source>();
}

constexpr std::array kSources{
    Entry{"box", make<BoxSource>},
    Entry{"sphere", make<SphereSource>},
    Entry{"mesh", make<MeshSource>},
};

}  // namespace

std::span<const std::string_view> fluidShapes() {
  return registryNames<kSources>();
}

std::unique_ptr<FluidSource> makeFluidSource(int shape) {
  return kSources.at(static_cast<std::size_t>(shape)).make();
}

}  // namespace migiwa
