// The commands of the program, in the order of --help.
#pragma once

#include <vector>

#include "app/commands/command.h"

namespace migiwa {

std::vector<Command> allCommands();

}  // namespace migiwa
