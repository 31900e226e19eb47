#include <array>

#include "core/base/registry.h"
#include "core/boundary/box.h"
#include "core/boundary/mesh_surface.h"
#include "core/boundary/plane.h"
#include "core/boundary/polynomial.h"
#include "core/boundary/slim_surface.h"
#include "core/boundary/sphere.h"

namespace migiwa {

namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<Surface> (*make)();
};

template <class Shape>
std::unique_ptr<Surface> make() {
  return std::make_unique<Shape>();
}

constexpr std::array kShapes{
    Entry{"plane", make<Plane>},           Entry{"box", make<Box>},          Entry{"sphere", make<Sphere>},
    Entry{"polynomial", make<Polynomial>}, Entry{"slim", make<SlimSurface>}, Entry{"mesh", make<MeshSurface>},
};

}  // namespace

std::span<const std::string_view> surfaceShapes() {
  return registryNames<kShapes>();
}

std::unique_ptr<Surface> makeSurface(int shape) {
  return kShapes.at(static_cast<std::size_t>(shape)).make();
}

}  // namespace migiwa
