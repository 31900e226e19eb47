#include "app/commands/command_registry.h"

namespace migiwa {

std::vector<Command> allCommands() {
  return {viewCommand(),    renderCommand(), simulateCommand(), checkCommand(), gammaCommand(),
          summaryCommand(), slimCommand(),   studyCommand(),    schemaCommand()};
}

}  // namespace migiwa
