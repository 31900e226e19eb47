// Studies as a user runs them: in one go, in parts, merged, and with mistakes.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/study/study_program.h"

namespace migiwa::testing {
namespace study_command_test {

class StudyCommand : public StudyProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(folder_ / "tank.json") << R"({ "format": 1, "particle_spacing": 0.1,
      "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.4, 0.6, 0.5] } ],
      "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [0, 0, 0],
                                     "max": [0.8, 1, 0.5] } ] } })";
  }

  static Words study(const std::string& out, const Words& more = {}) {
    Words words{"study",    "tank.json",
                "--vary",   "/boundary/gamma/method=auto,mean",
                "--vary",   "/solver/max_iterations=2,6",
                "--until",  "0.2",
                "--repeat", "2",
                "--out",    out};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

TEST_F(StudyCommand, WritesTableSummaryAndPictures) {
  expectDone(run(study("all")));
  const std::string text = table("all");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 5);
  EXPECT_NE(text.find("\n3,mean,2,"), std::string::npos) << text;
  for (const char* name : {"summary.md", "cost_accuracy.png", "gamma_error.png", "runs/4.json"})
    EXPECT_TRUE(fs::exists(folder_ / "all" / name)) << name;
  EXPECT_NE(readAll(folder_ / "all" / "summary.md").find("on the front"), std::string::npos);
}

TEST_F(StudyCommand, InPartsInterruptedAndMergedItIsTheSame) {
  expectDone(run(study("all")));
  const std::string whole = table("all");

  // Some runs first, in any order, then the rest.
  expectDone(run(study("parts", {"--run", "3"})));
  EXPECT_FALSE(fs::exists(folder_ / "parts" / "study.csv"));
  expectDone(run(study("parts", {"--run", "1"})));
  const std::string kept = readAll(folder_ / "parts" / "runs" / "3.json");
  expectDone(run(study("parts")));
  EXPECT_EQ(table("parts"), whole);
  EXPECT_EQ(readAll(folder_ / "parts" / "runs" / "3.json"), kept);

  // From two folders.
  for (const char* number : {"1", "2"}) expectDone(run(study("left", {"--run", number})));
  for (const char* number : {"3", "4"}) expectDone(run(study("right", {"--run", number})));
  const Outcome missing = run(study("joined", {"--merge", "left"}));
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.err.find("none of 3, 4"), std::string::npos) << missing.err;
  expectDone(run(study("joined", {"--merge", "left", "right"})));
  EXPECT_EQ(table("joined"), whole);
}

TEST_F(StudyCommand, AnotherStudysRunsAreRefused) {
  expectDone(run(study("all", {"--run", "2"})));
  const Outcome outcome = run(study("all", {"--set", "/particle_spacing=0.09"}));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("2.json: expected run 2 of this study, found one of another"), std::string::npos)
      << outcome.err;
  std::ofstream(folder_ / "all" / "runs" / "1.json") << "{}";
  const Outcome broken = run(study("all"));
  EXPECT_EQ(broken.code, 2);
  EXPECT_NE(broken.err.find("1.json: expected the record of a study's run"), std::string::npos) << broken.err;
}

TEST_F(StudyCommand, ListNumbersTheRuns) {
  const Outcome outcome = run(study("none", {"--list"}));
  expectDone(outcome);
  EXPECT_EQ(outcome.out,
            "1\t/boundary/gamma/method=auto\t/solver/max_iterations=2\n"
            "2\t/boundary/gamma/method=auto\t/solver/max_iterations=6\n"
            "3\t/boundary/gamma/method=mean\t/solver/max_iterations=2\n"
            "4\t/boundary/gamma/method=mean\t/solver/max_iterations=6\n");
  EXPECT_FALSE(fs::exists(folder_ / "none"));
}

TEST_F(StudyCommand, AllFaultsAreReportedAtOnce) {
  std::ofstream(folder_ / "file") << "in the way";
  const Outcome outcome = run({"study", "tank.json", "--vary", "/solver/max_iteration=2,3", "--vary",
                               "/boundary/gamma/method=auto,guess", "--vary", "/particle_spacing=", "--vary",
                               "/solver/tolerance=0.1,0.1", "--vary",
                               "/boundary/handling:/boundary/gamma/method=gamma:auto:3,none", "--until", "-1",
                               "--repeat", "0", "--out", "file/study"});
  EXPECT_EQ(outcome.code, 2);
  for (const char* piece : {"max_iteration", "guess", "/particle_spacing=", "0.1 again", "gamma:auto:3",
                            "--until", "--repeat", "--out: expected a folder, found the file"})
    EXPECT_NE(outcome.err.find(piece), std::string::npos) << piece << " in\n" << outcome.err;
  EXPECT_FALSE(fs::exists(folder_ / "study.csv"));
}

}  // namespace study_command_test
}  // namespace migiwa::testing
