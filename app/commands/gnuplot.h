// Pictures drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>

namespace migiwa {

/// Runs a script after `set terminal TERMINAL` and writes its picture to `png`, whole or not at all. Throws
/// MissingError when gnuplot is not there, with the package to install; when it fails, with what it said; and
/// when it is killed, with the signal. A picture that cannot be written is as in writeTextFile().
void drawWithGnuplot(const std::filesystem::path& png, const std::string& terminal,
                     const std::string& script);

}  // namespace migiwa
