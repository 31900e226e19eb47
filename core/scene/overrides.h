// `--set /json/pointer=VALUE` applied to a scene's document before it is read.
#pragma once

#include <vector>

#include "core/scene/fault_list.h"
#include "core/scene/json_document.h"
#include "core/scene/scene_reader.h"

namespace migiwa {

/// Sets the values in order. Objects on the way that are missing are made, entries of arrays are not.
void applyOverrides(const std::vector<Override>& overrides, Json& root, FaultList& faults);

}  // namespace migiwa
