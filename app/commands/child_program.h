// Other programs that this one starts: gnuplot for plots, encoders for films.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace migiwa {

struct ProgramCall {
  std::vector<std::string> words;  ///< the program's name, looked for on PATH, and its arguments
  std::string input{};             ///< what it reads from its standard input
  std::filesystem::path folder{};  ///< where it runs; empty: where this program does
};

/// How a program ended.
struct ProgramEnd {
  int status = 0;                   ///< as waitpid() says it
  std::string printed, complaints;  ///< on its standard output, on its standard error stream

  bool killed() const;
  int exitCode() const;
  /// Such as "gnuplot was killed by signal 9 (Killed), as the system does for want of memory; it said ...".
  std::string killedWords(const std::string& name) const;
  /// What it complained of last, on one line: "it said: ..." or "it said nothing".
  std::string lastWords() const;
};

/// Runs a program and waits for its end. Nothing where PATH has no such program. Throws MissingError, which
/// begins with `purpose`, where it cannot be started.
std::optional<ProgramEnd> runProgram(const ProgramCall& call, const std::string& purpose);

/// Whether PATH has a program of that name that may be run.
bool programExists(std::string_view name);

}  // namespace migiwa
