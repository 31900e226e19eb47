// Pictures drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>

namespace migiwa {

/// Runs a script after `set terminal TERMINAL` and writes its picture to `png`, whole or not at all. Throws
/// MissingError when gnuplot is not there or fails, InputError when the picture cannot be written.
void drawWithGnuplot(const std::filesystem::path& png, const std::string& terminal,
                     const std::string& script);

}  // namespace migiwa
