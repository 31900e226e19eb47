// The program started as a user starts it, in an empty folder of its own.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>

namespace migiwa::testing {

struct Outcome {
  int code = -1;
  std::string out, err;
};

inline std::string readAll(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// In single quotes, so that the shell passes it on as it is.
inline std::string shellQuoted(const std::string& word) {
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const ::testing::TestInfo* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    base_ = std::filesystem::path(::testing::TempDir()) /
            (std::string("migiwa_") + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(base_);
    folder_ = base_ / "work";
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(base_); }

  /// `before` is a shell command that runs first, such as a limit.
  Outcome run(const std::vector<std::string>& arguments, const std::string& before = "true") const {
    std::string command =
        "cd " + shellQuoted(folder_.string()) + " && " + before + " && exec " + shellQuoted(MIGIWA_PROGRAM);
    for (const std::string& argument : arguments) command += " " + shellQuoted(argument);
    command += " >" + shellQuoted((base_ / "out").string()) + " 2>" + shellQuoted((base_ / "err").string());
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readAll(base_ / "out"), readAll(base_ / "err")};
  }

  bool folderIsEmpty() const { return std::filesystem::is_empty(folder_); }

  std::filesystem::path base_, folder_;
};

}  // namespace migiwa::testing
