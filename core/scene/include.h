// A scene that names another one: "include" and "set", before a scene is read.
//
// `include` names a scene file, relative to the one that names it; its keys are taken over and the other keys
// of the including file are merged over them as JSON Merge Patch (RFC 7396) says: objects merge by key, lists
// and plain values replace, null takes a key out. `set` then changes single values by JSON pointer, as --set
// does, and so reaches into lists.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/base/fields.h"
#include "core/scene/fault_list.h"
#include "core/scene/json_document.h"

namespace migiwa {

inline constexpr std::string_view kIncludeKey = "include";
inline constexpr std::string_view kSetKey = "set";
inline constexpr FieldDoc kIncludeDoc{
    "",
    "Another scene file, relative to this one, whose keys are taken over; the other keys here are merged "
    "over "
    "them: objects by key, lists and values as a whole, and null takes a key out."};
inline constexpr FieldDoc kSetDoc{
    "",
    "JSON pointers and values, put in last, as --set does: the way into lists (/fluid/0/max/1; /fluid/- adds "
    "an entry)."};

/// The document with all that it includes put together, without "include" and "set". Tells the faults'
/// origins what comes from where. Throws InputError when a file of the chain cannot be had; lesser faults are
/// added.
Json resolveIncludes(std::string_view text, const std::filesystem::path& name, FaultList& faults);

}  // namespace migiwa
