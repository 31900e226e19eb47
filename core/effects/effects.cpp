#include "core/effects/effects.h"

#include <array>

#include "core/base/fields.h"

namespace migiwa {

namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<Effect> (*make)();
};

constexpr std::array kEffects{
    Entry{"viscosity", makeViscosity},
    Entry{"vorticity_confinement", makeVorticityConfinement},
    Entry{"surface_tension", makeSurfaceTension},
    Entry{"artificial_pressure", makeArtificialPressure},
    Entry{"wall_friction", makeWallFriction},
};

}  // namespace

std::span<const std::string_view> effectNames() {
  return registryNames<kEffects>();
}

std::unique_ptr<Effect> makeEffect(int effect) {
  return kEffects.at(static_cast<std::size_t>(effect)).make();
}

}  // namespace migiwa
