// A command of the program: one file that defines it, and one line in app/command_line.cpp. Below, what
// commands share.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "app/session/ui_state.h"
#include "core/base/messages.h"
#include "core/io/report.h"
#include "core/scene/scene_file.h"

namespace migiwa {

/// Exit codes that people script against.
enum ExitCode { kDone = 0, kBadInput = 2, kNumericalTrouble = 3, kSomethingMissing = 4 };

/// The longest run that an option can ask for (s): as long as a scene's duration can be.
inline constexpr double kLongestRun = 1e6;

/// Options that every command takes.
struct CommonOptions {
  std::vector<Override> overrides;  ///< --set, in order
  int threads = 0;                  ///< --threads; 0: all that the machine has
  bool quiet = false;               ///< --quiet: no progress
};

/// Where the value of an option goes; a bool is a flag. What is optional stays empty where the option is left
/// out.
using OptionTarget = std::variant<bool*, int*, std::string*, std::vector<std::string>*, std::optional<int>*,
                                  std::optional<long>*, std::optional<double>*>;

/// An option of a command, as --help shows it.
struct Option {
  std::string name{};  ///< such as "--until"; without dashes it is given by its position
  OptionTarget target{};
  std::string value{};  ///< what stands for the value in --help, such as "S"
  std::string help{};
  bool required = false;
  bool oneValueEach = false;                   ///< of a list: each --name takes one
  std::optional<std::array<long, 2>> range{};  ///< least and largest value
  std::string shownDefault{};
  std::vector<std::string> excludes{};  ///< names of options before it that it cannot stand beside
  std::string group{};                  ///< a heading of --help
};

/// A command's own options, and what to run once they are parsed: it returns an ExitCode and throws
/// InputError or MissingError.
struct Declaration {
  std::vector<Option> options;
  std::function<int(const CommonOptions&)> run;
  std::string footer{};  ///< of --help
};

struct Command {
  std::string name;
  std::string summary;  ///< one line for --help
  std::function<Declaration()> declare;
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
Command truthCommand();
Command surfaceCommand();
Command sectionCommand();

/// What is shipped under that name: in the current folder, or in the repository that the program was built
/// in. Throws InputError at `option` where it is in neither; `what` such as "a scene file".
std::filesystem::path shippedPlace(const std::filesystem::path& name, const std::string& option,
                                   const std::string& what);

// What `migiwa view` can open.

/// The scenes that were opened last, and those that are shipped.
std::vector<GalleryEntry> galleryEntries();
/// Reads a scene, or makes one around a mesh, points or a SLIM surface, and remembers it as opened. Throws
/// InputError.
Scene openScene(const std::filesystem::path& file, const std::vector<Override>& overrides);

// Option values that are lists or pairs, read from their text. Faults name the option.

/// `0,0.5,1`: times in s, sorted, each once. Throws InputError.
std::vector<double> parseTimes(const std::string& text, std::string_view option);
/// `1280x720`: width and height in pixels. Throws InputError.
std::array<int, 2> parseSize(const std::string& text, std::string_view option);
/// `/json/pointer=a,b,c`: one override for each value; commas inside brackets and quotes part nothing. Throws
/// InputError.
std::vector<Override> parseVariants(const std::string& text, std::string_view option);

/// Numbers with commas between them, as many as there is room for, each a coordinate that a scene can have.
/// False where the text is anything else.
bool readNumbers(std::string_view text, std::span<double> numbers);
/// Throws InputError at `option` where there is a value that the range does not have.
void requireNumber(const std::string& option, const std::optional<double>& value, const Range& range,
                   std::string_view unit);
/// Which of the names it is. Throws InputError at `option` where it is none.
std::size_t requireOneOf(const std::string& option, const std::string& name,
                         std::span<const std::string_view> names);

// One line on a terminal that tells how far a run is: time, speed, time left. Nothing where there is no
// terminal.

class ProgressBar {
 public:
  /// `from` and `until` are the simulated times (s) at the start and at the end. Silent when `quiet`, or when
  /// the standard error stream goes to a file.
  ProgressBar(double from, double until, bool quiet);
  /// Wipes the line, so that nothing of it stays between the messages around it.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `time` (s) is reached. Draws at most ten times a second.
  void update(double time);
  /// Makes room for another message; the next update draws it anew.
  void wipe();

 private:
  using Clock = std::chrono::steady_clock;

  double from_, until_;
  bool shown_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_ = start_;
};

// Trouble of a run on the standard error stream: each kind once, when it first happens.

class TroubleNotes {
 public:
  /// `scene` as it was given.
  explicit TroubleNotes(std::string scene) : scene_(std::move(scene)) {}

  /// Takes what a save brought as said.
  void takeAsSaid(const RunStatistics& run) { seen_ = run.trouble.size(); }
  /// Says what is new, but for steps that ended at max_iterations: an ordinary ending.
  void look(const RunStatistics& run, ProgressBar& progress);
  /// Of a run that has stopped: says all that was not said.
  void finish(const RunStatistics& run);

 private:
  void say(const Trouble& trouble);

  std::string scene_;
  std::size_t seen_ = 0;  ///< kinds that were looked at; new ones come last
  std::set<std::string, std::less<>> said_;
};

// Reports side by side, for a person to read.

/// An aligned table: a row for each measure with its unit, a column for each report. `labels` head the
/// columns; without them there is no heading.
std::string reportTable(const std::vector<Report>& reports, const std::vector<std::string>& labels = {});

// What a command was given may be wrong in several places: all of them are reported, not the first alone.

class FaultCollector {
 public:
  /// Runs a part of the checks; its faults are kept, and the next part runs all the same.
  template <class Body>
  void operator()(const Body& body) {
    try {
      body();
    } catch (const InputError& error) {
      for (const Fault& fault : error.faults()) add(fault);
    }
  }
  /// Keeps a fault, unless it is known already: a scene that is read twice has each of its own twice.
  void add(const Fault& fault) {
    const auto same = [&](const Fault& known) { return known.text() == fault.text(); };
    if (std::none_of(faults_.begin(), faults_.end(), same)) faults_.push_back(fault);
  }
  /// Throws all that were kept as one error, if there are any.
  void raise() {
    if (!faults_.empty()) throw InputError(std::move(faults_));
  }

 private:
  std::vector<Fault> faults_;
};

}  // namespace migiwa
