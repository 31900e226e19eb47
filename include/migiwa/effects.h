// Effects of your own: forces and whatever else acts on particles in a step.
//
//   Derive from EffectOf<Mine>; registerEffect gives it its name under "effects" of a scene. Of the StepState
//   that its functions get, these members are for effects: particles, current, density, gamma, neighbours,
//   pool, boundary, timeStep, spacing, supportRadius, gravity.
#pragma once

#include "core/base/fields.h"
#include "core/base/parallel.h"
#include "core/solver/effect.h"
#include "core/solver/state.h"
