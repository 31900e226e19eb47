// The particles that a scene starts with.
#pragma once

#include "core/boundary/boundary.h"
#include "core/scene/scene.h"
#include "core/solver/step_state.h"

namespace migiwa {

/// Fills every source with its lattice, trimmed at the solids. A source that trimming empties adds a warning.
void fillScene(Scene& scene, const Boundary& boundary, Particles& particles);

}  // namespace migiwa
