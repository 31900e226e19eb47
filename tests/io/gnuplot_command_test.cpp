// What is said where gnuplot is not there, fails, or is killed: three things, with three remedies.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/io/drop_test.h"

namespace migiwa::testing {
namespace {

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

}  // namespace
}  // namespace migiwa::testing
