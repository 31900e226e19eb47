// Studies started as a user starts them, and their tables.
#pragma once

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "core/study/study.h"
#include "tests/support/program.h"

namespace migiwa::testing {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class StudyProgramTest : public ProgramTest {
 protected:
  static Words cells(const std::string& line) {
    Words result;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) result.push_back(cell);
    return result;
  }

  /// The columns of a study's table by name, a cell a run.
  std::map<std::string, Words> columns(const std::string& out) const {
    std::istringstream in(readAll(folder_ / out / "study.csv"));
    std::map<std::string, Words> result;
    Words names;
    for (std::string line; std::getline(in, line);) {
      const Words row = cells(line);
      if (names.empty()) {
        names = row;
        continue;
      }
      for (std::size_t k = 0; k < names.size(); ++k)
        result[names[k]].push_back(k < row.size() ? row[k] : std::string());
    }
    return result;
  }

  /// The table less what depends on how it came about.
  std::string table(const std::string& out) const {
    std::istringstream in(readAll(folder_ / out / "study.csv"));
    std::string text, line;
    Words names;
    while (std::getline(in, line)) {
      const Words row = cells(line);
      if (names.empty()) names = row;
      for (std::size_t k = 0; k < row.size(); ++k)
        if (!isTimeColumn(names.at(k))) text += row[k] + ",";
      text += "\n";
    }
    return text;
  }

  static void expectDone(const Outcome& outcome) { EXPECT_EQ(outcome.code, 0) << outcome.err; }

  /// Starts a study and stops it by a signal as soon as a file is there, wherever it is then.
  void stopWhenThere(Words words, const fs::path& awaited, int signal) const {
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.c_str()) != 0) _exit(126);
      words.insert(words.begin(), MIGIWA_PROGRAM);
      std::vector<char*> pointers;
      for (std::string& word : words) pointers.push_back(word.data());
      pointers.push_back(nullptr);
      if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(126);
      execv(MIGIWA_PROGRAM, pointers.data());
      _exit(127);
    }
    int status = 0;
    while (!fs::exists(folder_ / awaited) && waitpid(child, &status, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ::kill(child, signal);
    waitpid(child, &status, 0);
  }
};

}  // namespace migiwa::testing
