#include <csignal>
#include <cstdlib>
#include <exception>
#include <string_view>

#include <unistd.h>

#include "app/command_line.h"
#include "app/commands/command.h"

namespace {

/// A failure that nothing could catch, such as one in a destructor or on a thread of a library.
[[noreturn]] void endWithACode() {
  const std::exception_ptr failure = std::current_exception();
  std::_Exit(failure ? migiwa::exitCodeOf(failure) : migiwa::kNumericalTrouble);
}

/// Nothing of this program aborts; a graphics driver that gets no memory does.
extern "C" void endOfALibrary(int /*signal*/) {
  constexpr std::string_view kMessage = "migiwa: a library gave up, as drivers do for want of memory\n";
  if (write(STDERR_FILENO, kMessage.data(), kMessage.size()) < 0) std::_Exit(migiwa::kSomethingMissing);
  std::_Exit(migiwa::kSomethingMissing);
}

}  // namespace

int main(int argc, char** argv) {
  // A file beyond the limit that the user has set, or a pipe whose reader is gone, is an error like any
  // other, told with the file's name.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGABRT, endOfALibrary);
  std::set_terminate(endWithACode);
  return migiwa::runCommandLine({argv + 1, argv + argc});
}
