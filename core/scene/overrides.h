// Values put into a scene's document by JSON pointer before it is read: `--set /json/pointer=VALUE`, and the
// same under "set" in a scene file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/fault_list.h"
#include "core/scene/json_document.h"
#include "core/scene/scene_reader.h"

namespace migiwa {

/// The tokens of a JSON pointer (RFC 6901); nothing if it does not begin with '/' or an escape is wrong.
std::optional<std::vector<std::string>> pointerTokens(std::string_view pointer);

/// Sets one value. Objects on the way that are missing are made, entries of arrays are not; the last token
/// "-" adds an entry to an array, and null takes a member out of its object. `origin`: where the value was
/// written.
void setValue(Json& root, const std::string& pointer, Json value, const Origin& origin, FaultList& faults);

/// Sets the values in order.
void applyOverrides(const std::vector<Override>& overrides, Json& root, FaultList& faults);

}  // namespace migiwa
