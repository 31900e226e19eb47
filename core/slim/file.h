// Files of fitted SLIM surfaces: a JSON header with the fit's figures, and the nodes as one array of 32-bit
// floats in base64, little-endian, node by node in the order that "layout" names.
//   { "format": "migiwa-slim", "version": 2, "degree": 2, "closed": true, "nodes": 4998,
//     "statistics": { "source": "bunny.obj", "largest": 0.005, "mean": 0.0004, "points": 100000 },
//     "layout": ["centre", "radius", "normal", "tangent", "coefficients", "error"], "data": "...",
//     "hierarchy": { "nodes": 4210, "data": "...", "children": "..." } }
// The coarser balls of the hierarchy lie in the same layout, children before parents; "children" holds the
// numbers of two balls for each of them, 32-bit unsigned, counted on from the nodes above. Files without a
// hierarchy, as version 1 has them, are read too.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/slim/fit.h"

namespace migiwa {

/// Text of a file that holds `data`.
std::string slimFileText(const SlimData& data);

/// Reads such a file. Throws InputError, with the file and the JSON pointer or the byte as its place, for a
/// missing, truncated or foreign one.
SlimData readSlimFile(const std::filesystem::path& file);
/// The same for a text in memory; `name` stands in for the file in faults.
SlimData parseSlimFile(const std::string& text, const std::string& name);

// Bytes as text (RFC 4648).

std::string base64(std::span<const std::byte> bytes);
/// False unless `text` is base64 with its padding.
bool decodeBase64(std::string_view text, std::vector<std::byte>& bytes);

}  // namespace migiwa
