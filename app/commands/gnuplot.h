// Pictures drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>

namespace migiwa {

/// Runs a script after `set terminal TERMINAL` and writes its picture to `png`, under a temporary name until
/// it is whole. Throws MissingError when gnuplot is not there or fails.
void drawWithGnuplot(const std::filesystem::path& png, const std::string& terminal,
                     const std::string& script);

}  // namespace migiwa
