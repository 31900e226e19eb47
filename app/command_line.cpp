#include "app/command_line.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

#include <CLI/CLI.hpp>

#include "app/commands/command_registry.h"
#include "core/base/error.h"
#include "core/scene/nearest_name.h"

namespace migiwa {

namespace {

constexpr int kMostThreads = 256;
constexpr const char* kExitCodes =
    "Exit codes:\n"
    "  0  done\n"
    "  2  what was given is wrong: each fault with its place, what was expected and what was found\n"
    "  3  numerical trouble: a value that is not finite, a lost particle, a bound that was broken\n"
    "  4  something is missing here: a display, EGL, gnuplot, memory, room for what is written\n";

/// What every command line holds beside the command's own options.
struct CommonWords {
  std::vector<std::string> overrides;
  int threads = 0;
  bool quiet = false;
};

/// A command as it is known to the parser.
struct Declared {
  CLI::App* parser;
  std::function<int(const CommonOptions&)> run;
};

void addCommonOptions(CLI::App& parser, CommonWords& words) {
  parser
      .add_option("--set", words.overrides,
                  "Changes the scene: /json/pointer=VALUE, with a JSON value or a bare word. Repeatable.")
      ->type_name("/POINTER=VALUE")
      ->allow_extra_args(false)
      ->group("Every command");
  parser.add_option("--threads", words.threads, "Threads to use; 0 takes what the machine has.")
      ->type_name("N")
      ->check(CLI::Range(0, kMostThreads))
      ->default_str("0")
      ->group("Every command");
  parser.add_flag("--quiet", words.quiet, "No progress.")->group("Every command");
}

CommonOptions commonOptions(const CommonWords& words) {
  CommonOptions options;
  std::vector<Fault> faults;
  for (const std::string& word : words.overrides) {
    try {
      options.overrides.push_back(Override::parse(word));
    } catch (const InputError& error) {
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  }
  if (!faults.empty()) throw InputError(std::move(faults));
  options.threads = words.threads;
  options.quiet = words.quiet;
  return options;
}

/// The command comes first; says so where it does not.
void requireCommand(const std::vector<std::string>& arguments, const std::vector<Command>& commands) {
  const std::string& first = arguments.front();
  if (first == "--help" || first == "-h") return;
  std::vector<std::string_view> names;
  names.reserve(commands.size());
  for (const Command& command : commands) names.push_back(command.name);
  if (std::find(names.begin(), names.end(), first) != names.end()) return;
  std::string message = "expected a command first (" + quotedList(names) + "), found \"" + first + "\"";
  if (first.ends_with(".json")) message += "; did you mean: migiwa view " + first;
  throw InputError("migiwa", message);
}

int parseAndRun(std::vector<std::string> arguments) {
  CLI::App program("Migiwa: particle fluids at walls.", "migiwa");
  program.footer(
      std::string("Without a command, the window opens. More about a command: migiwa COMMAND --help\n\n") +
      kExitCodes);
  program.require_subcommand(1);

  const std::vector<Command> commands = allCommands();
  CommonWords words;
  std::vector<Declared> declared;
  for (const Command& command : commands) {
    CLI::App* const parser = program.add_subcommand(command.name, command.summary);
    declared.push_back({parser, command.setUp(*parser)});
    addCommonOptions(*parser, words);
    const std::string own = parser->get_footer() == program.get_footer() ? "" : parser->get_footer() + "\n\n";
    parser->footer(own + kExitCodes);
  }

  if (arguments.empty()) arguments.emplace_back("view");
  requireCommand(arguments, commands);
  std::reverse(arguments.begin(), arguments.end());  // the parser takes them from the back
  try {
    program.parse(arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help
    const auto chosen = program.get_subcommands();
    std::cerr << "migiwa: " << error.what() << "\nTry: migiwa "
              << (chosen.empty() ? "" : chosen.front()->get_name() + " ") << "--help\n";
    return kBadInput;
  }
  const auto chosen = std::find_if(declared.begin(), declared.end(),
                                   [](const Declared& command) { return command.parser->parsed(); });
  return chosen->run(commonOptions(words));
}

/// What was printed may still be in memory, and may not fit where it goes, or nobody may read it any more.
void requirePrinted() {
  if (!std::cout.flush() || std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw OutputError("standard output",
                      "could not be written to its end: is its disk full, or its reader gone?");
}

int told(int code, const std::string& message) {
  std::cerr << message << '\n';
  return code;
}

constexpr const char* kNoMemory = "migiwa: out of memory; a larger particle_spacing takes less";

}  // namespace

int exitCodeOf(std::exception_ptr failure) {
  try {
    std::rethrow_exception(std::move(failure));
  } catch (const InputError& error) {
    return told(kBadInput, error.what());
  } catch (const OutputError& error) {
    return told(kSomethingMissing, error.what());
  } catch (const MissingError& error) {
    return told(kSomethingMissing, std::string("migiwa: ") + error.what());
  } catch (const std::bad_alloc&) {
    return told(kSomethingMissing, kNoMemory);
  } catch (const std::length_error&) {
    return told(kSomethingMissing, kNoMemory);  // an array longer than any memory
  } catch (const std::filesystem::filesystem_error& error) {
    return told(kBadInput, std::string("migiwa: expected a path that can be used, found one that cannot: ") +
                               error.what());
  } catch (const std::system_error& error) {
    return told(kSomethingMissing, std::string("migiwa: the system refuses: ") + error.what());
  } catch (const std::exception& error) {
    return told(kNumericalTrouble, std::string("migiwa: unforeseen: ") + error.what());
  } catch (...) {
    return told(kNumericalTrouble, "migiwa: unforeseen");
  }
}

int runCommandLine(std::vector<std::string> arguments) {
  int code = kDone;
  try {
    code = parseAndRun(std::move(arguments));
  } catch (...) {
    code = exitCodeOf(std::current_exception());
  }
  try {
    requirePrinted();
  } catch (...) {
    const int ofPrinting = exitCodeOf(std::current_exception());
    if (code == kDone) code = ofPrinting;  // what else went wrong has been told, and is more
  }
  return code;
}

}  // namespace migiwa
