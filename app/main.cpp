#include <csignal>

#include "app/command_line.h"

int main(int argc, char** argv) {
  // A file beyond the limit that the user has set is an error like any other, told with the file's name.
  std::signal(SIGXFSZ, SIG_IGN);
  return migiwa::runCommandLine({argv + 1, argv + argc});
}
