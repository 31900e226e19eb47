#include <array>

#include "core/effects/effects.h"

namespace migiwa {

namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<Effect> (*make)();
};

constexpr std::array kEffects{
    Entry{"viscosity", makeViscosity},
};

}  // namespace

std::span<const std::string_view> effectNames() {
  static const auto names = [] {
    std::array<std::string_view, kEffects.size()> result;
    for (std::size_t k = 0; k < kEffects.size(); ++k) result[k] = kEffects[k].name;
    return result;
  }();
  return names;
}

std::unique_ptr<Effect> makeEffect(int effect) {
  return kEffects.at(static_cast<std::size_t>(effect)).make();
}

}  // namespace migiwa
