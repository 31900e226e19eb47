// The kinds of failure that reach a user, one exception each; the program maps them to exit codes.
// Numerical trouble is not among them: it is data on a step's report (core/solver/trouble.h).
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace migiwa {

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

}  // namespace migiwa
