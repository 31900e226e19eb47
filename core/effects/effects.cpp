#include "core/effects/effects.h"

#include "core/base/registry.h"

namespace migiwa {

namespace {

Registry<Effect>& effects() {
  static Registry<Effect> all("an effect", {
                                               {"viscosity", makeViscosity},
                                               {"vorticity_confinement", makeVorticityConfinement},
                                               {"surface_tension", makeSurfaceTension},
                                               {"artificial_pressure", makeArtificialPressure},
                                               {"wall_friction", makeWallFriction},
                                           });
  return all;
}

}  // namespace

std::span<const std::string_view> effectNames() {
  return effects().names();
}

std::unique_ptr<Effect> makeEffect(int effect) {
  return effects().make(effect);
}

void registerEffect(const std::string& name, std::function<std::unique_ptr<Effect>()> make) {
  effects().add(name, std::move(make));
}

}  // namespace migiwa
