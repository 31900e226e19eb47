// What is said where gnuplot is not there, fails, or is killed: three things, with three remedies.
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/io/drop_test.h"

namespace migiwa::testing {
namespace gnuplot_command_test {

namespace fs = std::filesystem;

class GnuplotCommand : public DropTest {
 protected:
  /// A map is drawn with a program of this text as gnuplot; empty: with none.
  Outcome mapWith(const std::string& gnuplot) const {
    fs::create_directory(folder_ / "bin");
    if (!gnuplot.empty()) {
      std::ofstream(folder_ / "bin" / "gnuplot") << "#!/bin/sh\n" << gnuplot << '\n';
      fs::permissions(folder_ / "bin" / "gnuplot", fs::perms::owner_all);
    }
    return run({"gamma", "drop.json", "--map", "out"}, "PATH=$PWD/bin && export PATH");
  }
  void expectNoPicture(const Outcome& outcome, const std::string& message) const {
    EXPECT_EQ(outcome.code, 4);
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::exists(folder_ / "out" / "drop_gamma.csv")) << "the values need no gnuplot";
    EXPECT_FALSE(fs::exists(folder_ / "out" / "drop_gamma.png"));
  }
  void expectNoInstall(const Outcome& outcome) const {
    EXPECT_EQ(outcome.err.find("install"), std::string::npos) << outcome.err;
  }
};

TEST_F(GnuplotCommand, OneThatIsMissingIsToBeInstalled) {
  expectNoPicture(mapWith(""), "out/drop_gamma.png needs gnuplot; install gnuplot-nox");
}

TEST_F(GnuplotCommand, OneThatMayNotRunIsThere) {
  fs::create_directories(folder_ / "bin");
  std::ofstream(folder_ / "bin" / "gnuplot") << "no program";
  const Outcome outcome = run({"gamma", "drop.json", "--map", "out"}, "PATH=$PWD/bin && export PATH");
  expectNoPicture(outcome, "needs gnuplot, which cannot be started: Permission denied");
  expectNoInstall(outcome);
}

TEST_F(GnuplotCommand, OneThatFailsIsHeard) {
  const Outcome outcome = mapWith("echo 'line 3:  no room for a' >&2; echo 'temporary file' >&2; exit 5");
  expectNoPicture(outcome,
                  "gnuplot failed with exit code 5 and no picture; it said: line 3: no room for a "
                  "temporary file; the disk");
  expectNoInstall(outcome);
}

TEST_F(GnuplotCommand, OneThatFailsWithinAPictureLeavesNone) {
  const Outcome outcome = mapWith("echo half; exit 1");
  expectNoPicture(outcome, "gnuplot failed with exit code 1; it said nothing");
  expectNoInstall(outcome);
}

TEST_F(GnuplotCommand, OneThatDrawsNothingHasFailed) {
  const Outcome outcome = mapWith("exit 0");
  expectNoPicture(outcome, "gnuplot failed with exit code 0 and no picture");
  expectNoInstall(outcome);
}

TEST_F(GnuplotCommand, OneThatIsKilledWasKilled) {
  const Outcome outcome = mapWith("kill -9 $$");
  expectNoPicture(outcome, "gnuplot was killed by signal 9 (Killed)");
  expectNoInstall(outcome);
}

TEST_F(GnuplotCommand, ManyWordsAreCutToTheLast) {
  const Outcome outcome =
      mapWith("i=0; while [ $i -lt 20000 ]; do echo \"word $i\" >&2; i=$((i + 1)); done; exit 1");
  expectNoPicture(outcome, "word 19999; the disk");
  EXPECT_LT(outcome.err.size(), 1000U);
}

/// What gnuplot is told of a section, by one that keeps it.
class SectionCommandPicture : public DropTest {
 protected:
  std::string script(std::vector<std::string> words) const {
    fs::create_directories(folder_ / "bin");
    std::ofstream(folder_ / "bin" / "gnuplot") << "#!/bin/sh\ncat >script\necho picture\n";
    fs::permissions(folder_ / "bin" / "gnuplot", fs::perms::owner_all);
    words.insert(words.begin(), {"section"});
    words.insert(words.end(), {"--png", "s.png"});
    const Outcome outcome = run(words, "PATH=$PWD/bin:$PATH && export PATH");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return readAll(folder_ / "script");
  }
};

TEST_F(SectionCommandPicture, CellsOfASceneFarFromZeroStayApart) {
  std::ofstream(folder_ / "far.json") << R"({ "format": 1, "particle_spacing": 0.05, "duration": 0.1,
      "fluid": [ { "shape": "box", "min": [500000.2, 0, 0], "max": [500000.6, 0.4, 0.4] } ],
      "boundary": { "surfaces": [ { "shape": "box", "fluid": "inside", "min": [500000, 0, 0],
                                    "max": [500000.8, 1, 0.4] } ] } })";
  const std::string text = script({"far.json", "--plane", "z=0.2", "--cells", "200"});
  std::istringstream lines(text.substr(text.find("$map << EOD\n") + 12));
  std::set<std::string> across;
  std::string x, line;
  while (lines >> x && x != "EOD") across.insert(x), std::getline(lines, line);
  EXPECT_EQ(across.size(), 160U) << "columns of 5 mm";
  EXPECT_NE(text.find("'x - 500000 (m)'"), std::string::npos);
  EXPECT_NE(script({"far.json", "--plane", "x=500000.55"}).find("at x = 500000.55 m"), std::string::npos);
}

TEST_F(SectionCommandPicture, NoAxisIsAlongAZeroBelowZero) {
  const std::string text = script({"drop.json", "--normal", "1,1,-0", "--cells", "64"});
  EXPECT_NE(text.find("'along ("), std::string::npos) << "an axis at an angle";
  EXPECT_EQ(text.find("-0,"), std::string::npos);
  EXPECT_EQ(text.find("-0)"), std::string::npos);
}

/// By gnuplot itself, which takes neither an image of one column nor lines of nothing.
TEST_F(DropTest, ASectionWithoutLiquidAndOneOfASingleColumnAreDrawn) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--plane", "x=0.75"}, {"--plane", "x=0.4", "--cells", "2"}}) {
    std::vector<std::string> all{"section", "drop.json", "--png", "s.png"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = run(all);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GT(readAll(folder_ / "s.png").size(), 2000U);
    fs::remove(folder_ / "s.png");
  }
}

TEST_F(SectionCommandPicture, SaysWhereThereIsNoLiquid) {
  EXPECT_NE(script({"drop.json", "--plane", "x=0.75"}).find("no liquid on this plane"), std::string::npos);
}

}  // namespace gnuplot_command_test
}  // namespace migiwa::testing
