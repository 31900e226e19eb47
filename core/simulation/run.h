// A run to a given time, sampled for the report on the way. Watching or drawing a run never changes its
// stepping.
#pragma once

#include <functional>

#include "core/simulation/measures.h"
#include "core/simulation/simulation.h"

namespace migiwa {

/// Advances to the frame on which `until` (s) falls. `eachFrame` is called after every frame and may return
/// false to end early. Ends early, too, once the simulation has stopped itself. Samples the last tenth of the
/// run.
SettledMeasures runUntil(Simulation& simulation, double until, const std::function<bool()>& eachFrame = {});

/// The same with a sampler that lives on: one that comes with a save (core/io/save_file.h) goes on where it
/// was, if its run was to end on the same frame.
SettledMeasures runUntil(Simulation& simulation, double until, SettledSampler& sampler,
                         const std::function<bool()>& eachFrame = {});

}  // namespace migiwa
