// Baked grids on disk, so that the second start of a scene finds its grid. A file is taken only if it is
// whole and its key is, word for word, the one that is asked for; anything else counts as no file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/boundary/gamma/gamma_grid.h"

namespace migiwa {

/// Every field of every surface as text, files by their content: what tells one set of walls from another.
std::string describeWalls(const Boundary& boundary);

/// The file for a key, in a folder (cacheFolder()).
std::filesystem::path gridFile(const std::filesystem::path& folder, const std::string& key);

std::optional<GammaGrid> readGrid(const std::filesystem::path& file, const std::string& key);
/// Creates the folder too. Returns whether the file is now there, whole.
bool writeGrid(const std::filesystem::path& file, const std::string& key, const GammaGrid& grid);

}  // namespace migiwa
