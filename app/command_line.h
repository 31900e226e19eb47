// From the words of a command line to a finished command and its exit code.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "app/commands/command.h"

namespace migiwa {

/// Runs the program: `arguments` are those after its name; without any, the window opens. Reports failures on
/// the standard error stream, one line a fault, and returns the exit code, an ExitCode whatever happens.
int runCommandLine(std::vector<std::string> arguments);

/// Reports a failure on the standard error stream and returns its ExitCode.
int exitCodeOf(std::exception_ptr failure);

// The commands of the program, in the order of --help.

std::vector<Command> allCommands();

}  // namespace migiwa
