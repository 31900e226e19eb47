// The effects that effects.cpp lists, one file each.
#pragma once

#include <memory>

#include "core/solver/effect.h"

namespace migiwa {

std::unique_ptr<Effect> makeViscosity();
std::unique_ptr<Effect> makeVorticityConfinement();
std::unique_ptr<Effect> makeSurfaceTension();
std::unique_ptr<Effect> makeArtificialPressure();
std::unique_ptr<Effect> makeWallFriction();

}  // namespace migiwa
