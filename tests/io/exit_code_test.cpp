// Every end of the program has one of the codes that people script against: 0, 2, 3 or 4, whatever was given
// and however little memory there is.
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/io/drop_test.h"

namespace migiwa::testing {
namespace exit_code_test {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class ExitCode : public DropTest {
 protected:
  void SetUp() override {
    DropTest::SetUp();
    std::ofstream(folder_ / "points.csv") << "x,y,z\n0.1,0.1,0.1\n";
    std::ofstream(folder_ / "cube.obj")
        << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
           "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
  }

  /// Each command as it would do something small.
  static std::vector<Words> commands() {
    return {{"view", "drop.json"},
            {"render", "drop.json", "--out", "pictures", "--times", "0", "--size", "64x64"},
            {"simulate", "drop.json", "--until", "0.01"},
            {"check", "drop.json"},
            {"gamma", "drop.json", "--points", "points.csv", "--out", "gamma.csv"},
            {"slim", "cube.obj", "--out", "cube.json", "--degree", "1", "--nodes", "20"},
            {"study", "drop.json", "--vary", "/solver/max_iterations=2", "--until", "0.01", "--out", "study"},
            {"summary", "report.json"},
            {"schema"}};
  }

  static std::string shown(const Words& words) {
    std::string text;
    for (const std::string& word : words) text += word.substr(0, 60) + " ";
    return text;
  }
  static void expectListed(const Outcome& outcome, const Words& words) {
    EXPECT_TRUE((std::set<int>{0, 2, 3, 4}.count(outcome.code) == 1))
        << outcome.code << ": " << shown(words) << "\n"
        << outcome.err;
    if (outcome.code != 0) {
      EXPECT_NE(outcome.err, "") << shown(words);
    }
    EXPECT_EQ(outcome.err.find("unforeseen"), std::string::npos) << outcome.err;
  }
};

TEST_F(ExitCode, HelpNamesTheCodesForEveryCommand) {
  std::vector<Words> all = commands();
  for (Words& words : all) words.resize(1);
  all.emplace_back();
  for (Words words : all) {
    words.emplace_back("--help");
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 0);
    for (const char* line : {"Exit codes:", "  0  done", "  2  ", "  3  ", "  4  "}) {
      const std::size_t at = outcome.out.find(line);
      EXPECT_NE(at, std::string::npos) << shown(words) << line;
      EXPECT_EQ(outcome.out.find(line, at + 1), std::string::npos) << "twice: " << shown(words) << line;
    }
  }
}

TEST_F(ExitCode, WrongOptionsEndWithTwoInEveryCommand) {
  const std::vector<Words> wrong{{"--fly"},
                                 {"--threads"},
                                 {"--threads", ""},
                                 {"--threads", "-1"},
                                 {"--threads", "1e9"},
                                 {"--threads", "99999999999999999999"},
                                 {"--threads", "two"},
                                 {"--set"},
                                 {"--set", "x"},
                                 {"--set", "=1"},
                                 {"--set", "/~2=1"},
                                 {"--quiet=maybe"},
                                 {"one", "two", "three", "--four"}};
  for (const Words& command : commands()) {
    for (const Words& options : wrong) {
      Words words = command;
      words.insert(words.end(), options.begin(), options.end());
      const Outcome outcome = run(words, "unset DISPLAY WAYLAND_DISPLAY");
      EXPECT_EQ(outcome.code, 2) << shown(words) << outcome.err;
      expectListed(outcome, words);
    }
  }
}

TEST_F(ExitCode, WrongFilesEndWithTwoInEveryCommand) {
  fs::create_directory(folder_ / "folder.json");
  std::ofstream(folder_ / "file") << "no folder";
  const Words names{"none.json",
                    "folder.json",
                    "file/drop.json",
                    std::string(300, 'n') + ".json",
                    std::string(5000, 'n'),
                    "\xff\xfe.json",
                    "/dev/null",
                    "points.csv"};
  for (const Words& command : commands()) {
    if (command.size() < 2) continue;
    for (const std::string& name : names) {
      Words words = command;
      words[1] = name;
      const Outcome outcome = run(words, "unset DISPLAY WAYLAND_DISPLAY");
      EXPECT_EQ(outcome.code, 2) << shown(words) << outcome.err;
      expectListed(outcome, words);
    }
    for (std::size_t k = 2; k + 1 < command.size(); ++k) {
      if (command[k] != "--out") continue;
      for (const std::string& name : {std::string("file/out"), std::string(300, 'n'), std::string(5000, 'n'),
                                      std::string("/proc/none/out"), std::string("/dev/null/out")}) {
        Words words = command;
        words[k + 1] = name;
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 2) << shown(words) << outcome.err;
        expectListed(outcome, words);
      }
    }
  }
}

TEST_F(ExitCode, NumbersBeyondAllMeasureEndWithTwo) {
  const std::vector<Words> wrong{
      {"simulate", "drop.json", "--until", "1e308"},
      {"simulate", "drop.json", "--until", "1e6", "--set", "/solver/time_step=1e-9"},
      {"simulate", "drop.json", "--set", "/solver/time_step=1e-20"},
      {"simulate", "drop.json", "--set", "/particle_spacing=1e-12"},
      {"simulate", "drop.json", "--set", "/solver/time_step=1e-9", "--set", "/duration=1e6"},
      {"simulate", "drop.json", "--export", "a", "--every", "1e-400"},
      {"simulate", "drop.json", "--export", "a", "--every", "inf"},
      {"render", "drop.json", "--out", "a", "--times", "1e6", "--set", "/solver/time_step=1e-9", "--set",
       "/duration=0.1"},
      {"render", "drop.json", "--out", "a", "--size", "99999999999x64"},
      {"render", "drop.json", "--out", "a", "--size", "8192x8192", "--compare", "/solver/substeps=1,2,3,4,5"},
      {"study", "drop.json", "--out", "a", "--vary", "/solver/max_iterations=2", "--until", "1e6", "--set",
       "/solver/time_step=1e-9", "--set", "/duration=0.1"},
      {"study", "drop.json", "--out", "a", "--vary", "/solver/max_iterations=2", "--run",
       "99999999999999999999"},
      {"study", "drop.json", "--out", "a", "--vary", "/solver/max_iterations=2", "--repeat", "4294967297"},
      {"slim", "cube.obj", "--out", "a.json", "--nodes", "4294967306"},
      {"slim", "cube.obj", "--out", "a.json", "--tolerance", "1e-400"},
      {"gamma", "drop.json", "--map", "a", "--window", "0,0,1e300,1"}};
  for (const Words& words : wrong) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 2) << shown(words) << outcome.err;
    expectListed(outcome, words);
  }
  Words many{"study", "drop.json", "--out", "a"};
  for (int axis = 0; axis < 64; ++axis)
    many.insert(many.end(), {"--vary", "/view/key" + std::to_string(axis) + "=1,2"});
  const Outcome outcome = run(many);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("--vary: expected at most 10000 runs in all"), std::string::npos) << outcome.err;
}

TEST_F(ExitCode, AMapOfNextToNothingIsRefused) {
  for (const char* window :
       {"0,0,1e-300,1e-300", "0,0,1,1e-320", "0.1,0.1,0.1000000000001,0.2", "1e6,1e6,1000001,1000001"}) {
    const Words words{"gamma", "drop.json", "--map", "a", "--window", window};
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 2) << window << outcome.err;
    EXPECT_EQ(outcome.err.find("--window: expected sides of at least "), 0U) << outcome.err;
    expectListed(outcome, words);
  }
}

TEST_F(ExitCode, BytesThatAreNoTextDoNoHarm) {
  const std::string name = "\xff\xfe.json";
  fs::copy_file(folder_ / "drop.json", folder_ / name);
  for (const Words& words :
       {Words{"simulate", name, "--until", "0.01", "--report", "report.json"},
        Words{"simulate", name, "--until", "0.01", "--save", "a.save"},
        Words{"study", name, "--vary", "/solver/max_iterations=2", "--until", "0.01", "--out", "study",
              "--repeat", "1"},
        Words{"render", name, "--times", "0", "--size", "64x64", "--out", "pictures"},
        Words{"check", name, "--print"}, Words{"check", "drop.json", "--print", "--set", "/name=\xff"},
        Words{"simulate", "drop.json", "--until", "0.01", "--set", "/name=\xff", "--save", "b.save"},
        Words{"study", "drop.json", "--vary", "/name=\xff,b", "--until", "0.01", "--out", "other", "--repeat",
              "1"}})
    expectListed(run(words), words);
}

TEST_F(ExitCode, HoweverLittleMemoryThereIs) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take terabytes of addresses";
#endif
  // From the least with which the program starts at all.
  long least = 20000;
  const auto limit = [](long kibibytes) { return "ulimit -v " + std::to_string(kibibytes); };
  while (least < 4000000 && run({"--help"}, limit(least)).code != 0) least += least / 8;
  for (const Words& command : commands()) {
    if (command[0] == "view") continue;
    for (const long more : {0L, 500L, 2000L, 8000L, 30000L, 120000L}) {
      const Outcome outcome = run(command, "unset DISPLAY WAYLAND_DISPLAY; " + limit(least + more));
      expectListed(outcome, command);
    }
  }
  // Threads that the system does not give are done without.
  const Outcome outcome =
      run({"simulate", "drop.json", "--until", "0.01", "--threads", "256"}, limit(least + 500000));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

}  // namespace exit_code_test
}  // namespace migiwa::testing
