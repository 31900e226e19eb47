// Saving and going on as a user does it: through the program, also when it is killed or the disk is full.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/program.h"

namespace migiwa::testing {
namespace save_command_test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class SaveCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(folder_ / "drop.json") << R"({ "format": 1, "particle_spacing": 0.05,
      "fluid": [ { "shape": "box", "min": [0.2, 0.2, 0], "max": [0.6, 0.6, 0.4], "velocity": [2, -3, 0] } ],
      "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0],
                                     "max": [0.8, 1, 0.4] } ] } })";
  }

  /// Simulates the scene; the report's hash, or what went wrong.
  std::string hashOf(std::vector<std::string> options) const {
    options.insert(options.begin(), {"simulate", "drop.json", "--report", "report.json"});
    const Outcome outcome = run(options);
    if (outcome.code != 0) return "exit " + std::to_string(outcome.code) + ": " + outcome.err;
    return Json::parse(readAll(folder_ / "report.json"))["state_hash"].get<std::string>();
  }

  /// Starts the program in the folder without waiting for it.
  pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t child = fork();
    if (child != 0) return child;
    if (chdir(folder_.c_str()) != 0) _exit(126);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, 1), dup2(nowhere, 2);
    std::vector<std::string> words = arguments;
    words.insert(words.begin(), MIGIWA_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    execv(MIGIWA_PROGRAM, pointers.data());
    _exit(127);
  }
};

TEST_F(SaveCommand, AnInterruptedRunGoesOn) {
  const std::string whole = hashOf({"--until", "0.3", "--threads", "1"});
  ASSERT_EQ(whole.size(), 16U) << whole;
  EXPECT_EQ(hashOf({"--until", "0.3", "--save", "a.save", "--save-every", "0.1", "--threads", "3"}), whole);
  EXPECT_NE(hashOf({"--until", "0.2", "--save", "a.save"}), whole);
  EXPECT_EQ(hashOf({"--until", "0.3", "--resume", "a.save", "--save", "a.save", "--threads", "2"}), whole);
  EXPECT_EQ(hashOf({"--until", "0.3", "--resume", "a.save"}), whole) << "there is nothing left to do";
  EXPECT_EQ(hashOf({"--until", "0.2", "--resume", "a.save"}),
            "exit 2: --until: expected at least 0.3 s, the time of a.save, found 0.2 s\n");
  const std::string other = hashOf({"--resume", "a.save", "--set", "/solver/tolerance=0.5"});
  EXPECT_NE(other.find("exit 2: a.save:/scene/solver/tolerance: expected 0.5, found 0.003; "),
            std::string::npos)
      << other;
}

TEST_F(SaveCommand, AKilledRunLeavesAWholeSave) {
  const fs::path save = folder_ / "a.save";
  for (const int wait : {0, 1, 2, 3, 5, 7, 11, 13, 17, 23, 29, 37}) {
    fs::remove(save);
    const pid_t child =
        start({"simulate", "drop.json", "--until", "1000", "--save", "a.save", "--save-every", "0.005"});
    ASSERT_GT(child, 0);
    // Once there is a save, the next is on its way; however long it takes, what is there has to be whole.
    while (!fs::exists(save) && waitpid(child, nullptr, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(wait));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    ASSERT_TRUE(fs::exists(save));
    const std::string content = readAll(save);
    const std::size_t at = content.find("\"time\": ");
    ASSERT_NE(at, std::string::npos);
    const std::string until = std::to_string(std::stod(content.substr(at + 8)) + 0.02);
    const std::string whole = hashOf({"--until", until});
    ASSERT_EQ(whole.size(), 16U) << whole;
    EXPECT_EQ(hashOf({"--until", until, "--resume", "a.save"}), whole) << until;
  }
}

TEST_F(SaveCommand, AFileLimitIsToldAndTheOldSaveStays) {
  ASSERT_EQ(hashOf({"--until", "0.05", "--save", "a.save"}).size(), 16U);
  const std::string old = readAll(folder_ / "a.save");
  const Outcome outcome =
      run({"simulate", "drop.json", "--until", "0.1", "--save", "a.save"}, "ulimit -f 20");
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_EQ(outcome.err, "a.save: could not be written: File too large\n");
  EXPECT_EQ(readAll(folder_ / "a.save"), old);
  EXPECT_FALSE(fs::exists(folder_ / "a.save.tmp"));
}

TEST_F(SaveCommand, AFullDiskIsTold) {
  const Outcome outcome = run({"simulate", "drop.json", "--until", "0.05", "--save", "/dev/full"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_EQ(outcome.err, "/dev/full: could not be written: No space left on device\n");
}

TEST_F(SaveCommand, WhatCannotBeWrittenOrReadIsRefusedBeforeTheRun) {
  const auto refused = [&](const std::vector<std::string>& options, const std::string& message) {
    std::vector<std::string> arguments{"simulate", "drop.json", "--until", "100000"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << message;
    EXPECT_EQ(outcome.err.find(message), 0U) << outcome.err;
  };
  refused({"--save", "none/a.save"}, "--save: expected a file in a folder that exists");
  // A folder in which nobody may make files, not even the one who may do all else.
  refused({"--save", "/sys/a.save"}, "--save: expected a file that can be written, found /sys/a.save (");
  refused({"--save-every", "1"}, "--save-every: expected --save FILE with it, found none");
  refused({"--save", "a.save", "--save-every", "0"}, "--save-every: expected a number ");
  refused({"--resume", "a.save"}, "a.save: expected a save, found no such file");
  refused({"--resume", "drop.json"}, "drop.json: expected a save that migiwa simulate --save wrote");
  refused({"--resume", "/dev/zero"}, "/dev/zero: expected a save that migiwa simulate --save wrote");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace save_command_test
}  // namespace migiwa::testing
