// The effects that effect_registry.cpp lists, one file each.
#pragma once

#include <memory>

#include "core/effects/effect.h"

namespace migiwa {

std::unique_ptr<Effect> makeViscosity();

}  // namespace migiwa
