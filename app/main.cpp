#include "app/command_line.h"

int main(int argc, char** argv) {
  return migiwa::runCommandLine({argv + 1, argv + argc});
}
