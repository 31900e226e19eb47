// A command of the program. A command is one file that defines it and one line in command_registry.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/scene_reader.h"

namespace CLI {
class App;
}

namespace migiwa {

/// Exit codes that people script against.
enum ExitCode { kDone = 0, kBadInput = 2, kNumericalTrouble = 3, kSomethingMissing = 4 };

/// Options that every command takes.
struct CommonOptions {
  std::vector<Override> overrides;  ///< --set, in order
  int threads = 0;                  ///< --threads; 0: all that the machine has
  bool quiet = false;               ///< --quiet: no progress
};

struct Command {
  std::string name;
  std::string summary;  ///< one line for --help
  /// Declares the command's own options and returns what to run once they are parsed; that returns an
  /// ExitCode and throws InputError or MissingError.
  std::function<std::function<int(const CommonOptions&)>(CLI::App&)> setUp;
};

Command viewCommand();
Command renderCommand();
Command simulateCommand();
Command checkCommand();
Command gammaCommand();
Command summaryCommand();
Command slimCommand();
Command studyCommand();
Command schemaCommand();

}  // namespace migiwa
