// Fitted SLIM walls on disk, so that the second start of a scene need not fit them again. A file is taken
// only if it is whole and its key is, word for word, the one that is asked for; anything else counts as no
// file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/boundary/slim_source.h"

namespace migiwa {

/// What a fit gave, and what the import of its mesh had to say.
struct SlimFit {
  SlimData data;
  std::vector<std::string> notes;
};

/// All that the fit depends on, the content of the file included; empty where that cannot be read.
std::string slimFitKey(const SlimSource& source);
/// The file for a key, in a folder (cacheFolder()).
std::filesystem::path slimFitFile(const std::filesystem::path& folder, const std::string& key);

std::optional<SlimFit> readSlimFit(const std::filesystem::path& file, const std::string& key);
/// Creates the folder too. Returns whether the file is now there, whole.
bool writeSlimFit(const std::filesystem::path& file, const std::string& key, const SlimFit& fit);

}  // namespace migiwa
