#include "app/command_line.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "core/base/messages.h"
#include "core/base/progress.h"

namespace migiwa {

namespace {

constexpr int kMostThreads = 256;
constexpr const char* kExitCodes =
    "Exit codes:\n"
    "  0  done\n"
    "  2  what was given is wrong: each fault with its place, what was expected and what was found\n"
    "  3  numerical trouble: a value that is not finite, a lost particle, a bound that was broken\n"
    "  4  something is missing here: a display, EGL, gnuplot, an encoder, memory, room for what is written\n";

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

std::vector<Option> commonOptions(CommonWords& words) {
  const std::string group = "Every command";
  return {{.name = "--set",
           .target = &words.overrides,
           .value = "/POINTER=VALUE",
           .help = "Changes the scene: /json/pointer=VALUE, with a JSON value or a bare word. Repeatable.",
           .oneValueEach = true,
           .group = group},
          {.name = "--threads",
           .target = &words.threads,
           .value = "N",
           .help = "Threads to use; 0 takes what the machine has.",
           .range = {{0, kMostThreads}},
           .shownDefault = "0",
           .group = group},
          {.name = "--quiet", .target = &words.quiet, .help = "No progress.", .group = group}};
}

/// Says on the standard error stream what takes more than a second: one line that changes on a terminal, some
/// lines elsewhere.
class PreparationNotes final : public ProgressObserver {
 public:
  void reached(std::string_view what, double part) override {
    const Clock::time_point now = Clock::now();
    if (what != what_) what_ = what, began_ = now, told_ = now;
    const double elapsed = std::chrono::duration<double>(now - began_).count();
    const double silent = std::chrono::duration<double>(now - told_).count();
    const bool first = told_ == began_;
    if (elapsed < kPatience || (!first && silent < (terminal_ ? kRedraw : kRepeat))) return;
    told_ = now;
    shown_ = terminal_;
    std::fprintf(stderr, "%s%s: %.0f %%, %.0f s", terminal_ ? "\r" : "", what_.c_str(), 100 * part, elapsed);
    if (part > kTelling && part < 1) std::fprintf(stderr, ", %.0f s left", elapsed * (1 / part - 1));
    std::fputs(terminal_ ? "\033[K" : "\n", stderr);
    std::fflush(stderr);
  }
  void ended() override {
    if (shown_) std::fputs("\r\033[K", stderr);
    shown_ = false;
    what_.clear();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kPatience = 1, kRedraw = 0.1, kRepeat = 5;  // (s)
  static constexpr double kTelling = 0.02;  ///< part from which on time left can be told

  const bool terminal_ = isatty(STDERR_FILENO) == 1;
  std::string what_;
  Clock::time_point began_, told_;
  bool shown_ = false;
};

void addOption(CLI::App& parser, const Option& option) {
  CLI::Option* const added = std::visit(
      [&]<class T>(T* target) {
        if constexpr (std::is_same_v<T, bool>)
          return parser.add_flag(option.name, *target, option.help);
        else
          return parser.add_option(option.name, *target, option.help);
      },
      option.target);
  if (!option.value.empty()) added->type_name(option.value);
  if (option.required) added->required();
  if (option.oneValueEach) added->allow_extra_args(false);
  if (option.range) added->check(CLI::Range((*option.range)[0], (*option.range)[1]));
  if (!option.shownDefault.empty()) added->default_str(option.shownDefault);
  for (const std::string& other : option.excludes) added->excludes(parser.get_option(other));
  if (!option.group.empty()) added->group(option.group);
}

CommonOptions parsedOptions(const CommonWords& words) {
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
    Declaration own = command.declare();
    for (const Option& option : own.options) addOption(*parser, option);
    for (const Option& option : commonOptions(words)) addOption(*parser, option);
    parser->footer((own.footer.empty() ? "" : own.footer + "\n\n") + kExitCodes);
    declared.push_back({parser, std::move(own.run)});
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
  const CommonOptions options = parsedOptions(words);
  PreparationNotes notes;
  std::optional<ProgressScope> watched;
  if (!options.quiet) watched.emplace(notes);
  return chosen->run(options);
}

/// What was printed may still be in memory, and may not fit where it goes, or its reader may have ended.
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

std::vector<Command> allCommands() {
  return {viewCommand(),   renderCommand(),  simulateCommand(), checkCommand(),
          gammaCommand(),  summaryCommand(), slimCommand(),     studyCommand(),
          schemaCommand(), truthCommand(),   surfaceCommand(),  sectionCommand()};
}

}  // namespace migiwa
