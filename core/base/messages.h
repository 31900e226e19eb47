// What a user is told: failures, one exception each, which the program maps to exit codes; numbers as a
// person reads them; the name that was probably meant.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace migiwa {

// The kinds of failure. Numerical trouble is not among them: it is data of a run
// (core/simulation/statistics.h).

/// One thing that is wrong with what the user gave.
struct Fault {
  std::string place;    ///< `FILE:/json/pointer`, `FILE:line:column` or the command-line option
  std::string message;  ///< "expected ..., found ..." and, where there is one, the remedy
  std::string text() const { return place + ": " + message; }
};

/// What the user gave is wrong. Carries every fault found, not only the first. Exit code 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Fault> faults)
      : std::runtime_error(join(faults)), faults_(std::move(faults)) {}
  InputError(std::string place, std::string message)
      : InputError(std::vector<Fault>{{std::move(place), std::move(message)}}) {}
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  static std::string join(const std::vector<Fault>& faults);
  std::vector<Fault> faults_;
};

/// Something that this machine lacks: a display, an EGL device, room on a disk. The message says what to do
/// about it. Exit code 4.
class MissingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What was to be written could not be, for want of room or of a working disk: nothing that the user gave is
/// wrong. `place` is the file or the stream.
class OutputError : public MissingError {
 public:
  OutputError(const std::string& place, const std::string& message) : MissingError(place + ": " + message) {}
};

// Numbers as a person reads them; independent of the locale.

/// printf's format with one number.
std::string formatNumber(const char* format, double value);
/// With a comma between groups of three digits.
std::string groupedDigits(std::size_t value);
/// Wall time in milliseconds with three digits that mean something, or a dash where times are not to be
/// shown.
std::string milliseconds(double seconds, bool shown);

/// Round numbers in [low, high], about `wanted` of them, with the digits that tell them apart.
struct Ticks {
  std::vector<double> values;
  int decimals = 0;
};
Ticks roundTicks(double low, double high, int wanted);

// The known name that was probably meant.

/// Letters to insert, delete, replace or swap with their neighbour to get from one word to the other.
int editDistance(std::string_view a, std::string_view b);

/// The name with the smallest edit distance, the first of equals; empty without names.
std::string_view nearestName(std::string_view word, std::span<const std::string_view> names);

/// `"a", "b", "c"`.
std::string quotedList(std::span<const std::string_view> names);

}  // namespace migiwa
