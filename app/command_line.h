// From the words of a command line to a finished command and its exit code.
#pragma once

#include <string>
#include <vector>

namespace migiwa {

/// Runs the program: `arguments` are those after its name; without any, the window opens. Reports failures on
/// the standard error stream, one line a fault, and returns the exit code: an ExitCode, or 1 for what nobody
/// foresaw.
int runCommandLine(std::vector<std::string> arguments);

}  // namespace migiwa
