#include <array>

#include "core/boundary/box.h"
#include "core/boundary/plane.h"

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
    Entry{"plane", make<Plane>},
    Entry{"box", make<Box>},
};

}  // namespace

std::span<const std::string_view> surfaceShapes() {
  static const auto names = [] {
    std::array<std::string_view, kShapes.size()> result;
    for (std::size_t k = 0; k < kShapes.size(); ++k) result[k] = kShapes[k].name;
    return result;
  }();
  return names;
}

std::unique_ptr<Surface> makeSurface(int shape) {
  return kShapes.at(static_cast<std::size_t>(shape)).make();
}

}  // namespace migiwa
