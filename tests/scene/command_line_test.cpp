// The program as a user starts it: exit codes, where messages go, and that a refused run writes nothing.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program.h"

namespace migiwa::testing {
namespace command_line_test {

namespace fs = std::filesystem;

const std::string kScenes = MIGIWA_SOURCE_DIR "/scenes/";
const std::string kBad = MIGIWA_SOURCE_DIR "/tests/scene/bad/";

using CommandLine = ProgramTest;

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST_F(CommandLine, HelpIsAResultForEveryCommand) {
  const Outcome general = run({"--help"});
  EXPECT_EQ(general.code, 0);
  for (const char* command : {"view", "render", "simulate", "check", "summary"}) {
    EXPECT_NE(general.out.find(command), std::string::npos);
    const Outcome outcome = run({command, "--help"});
    EXPECT_EQ(outcome.code, 0) << command;
    for (const char* option : {"--set", "--threads", "--quiet", "--help"})
      EXPECT_NE(outcome.out.find(option), std::string::npos) << command << " " << option;
  }
}

TEST_F(CommandLine, WrongWordsAreRefused) {
  const std::vector<std::vector<std::string>> wrong{
      {"fly"},
      {"--fly"},
      {kScenes + "dam_break.json"},
      {"simulate"},
      {"simulate", kScenes + "dam_break.json", "--fly"},
      {"simulate", kScenes + "dam_break.json", "--until"},
      {"simulate", kScenes + "dam_break.json", "--until", "soon"},
      {"simulate", kScenes + "dam_break.json", "--until", "-1"},
      {"simulate", kScenes + "dam_break.json", "--until", "nan"},
      {"simulate", kScenes + "dam_break.json", "--until", "inf"},
      {"simulate", kScenes + "dam_break.json", "--threads", "257"},
      {"simulate", kScenes + "dam_break.json", "--threads", "-1"},
      {"simulate", kScenes + "dam_break.json", "--threads", "many"},
      {"simulate", kScenes + "dam_break.json", "--set", "duration=1"},
      {"simulate", kScenes + "dam_break.json", "--set"},
      {"simulate", kScenes + "dam_break.json", kScenes + "still_tank.json"},
      {"check"},
      {"summary"},
  };
  for (const auto& arguments : wrong) {
    const Outcome outcome = run(arguments);
    std::string shown;
    for (const std::string& argument : arguments) shown += argument + " ";
    EXPECT_EQ(outcome.code, 2) << shown;
    EXPECT_EQ(outcome.out, "") << shown;
    EXPECT_GE(lines(outcome.err), 1U) << shown;
  }
  EXPECT_TRUE(folderIsEmpty());
}

TEST_F(CommandLine, CheckAcceptsTheShippedScenes) {
  const Outcome outcome = run({"check", kScenes + "dam_break.json", kScenes + "still_tank.json"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, kScenes + "dam_break.json: ok (9216 particles at most)\n" + kScenes +
                             "still_tank.json: ok (7200 particles at most)\n");
}

TEST_F(CommandLine, EveryKindOfBadSceneEndsWithItsFaults) {
  for (const char* name : {"broken_comment", "duplicate_keys", "include_cycle", "include_faults_of_both",
                           "missing_files", "misplaced_keys", "degenerate_walls", "broken_utf16"}) {
    const std::string expected = readAll(kBad + name + std::string(".expected"));
    for (const char* command : {"check", "simulate"}) {
      const Outcome outcome = run({command, kBad + name + std::string(".json")});
      EXPECT_EQ(outcome.code, 2) << name;
      EXPECT_EQ(outcome.out, "") << name;
      EXPECT_EQ(lines(outcome.err), lines(expected)) << name << "\n" << outcome.err;
    }
  }
  EXPECT_TRUE(folderIsEmpty());
}

TEST_F(CommandLine, WhatCheckPrintsRunsToTheSameHash) {
  std::ofstream(folder_ / "variant.json")
      << R"({ "include": ")" << kScenes << R"(corner_drop.json", "solver": { "time_step": 0.01 },
              "set": { "/fluid/0/velocity/1": -2, "/boundary/surfaces/0/max/0": 1.5 } })";
  const Outcome printed = run({"check", "--print", "variant.json", "--set", "/particle_spacing=0.1"});
  ASSERT_EQ(printed.code, 0) << printed.err;
  std::ofstream(folder_ / "printed.json") << printed.out;
  const auto hash = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--until", "0.05", "--report", "report.json", "--quiet"});
    EXPECT_EQ(run(arguments).code, 0);
    const std::string report = readAll(folder_ / "report.json");
    const std::size_t at = report.find("\"state_hash\"");
    return report.substr(at, report.find('\n', at) - at);
  };
  const std::string found = hash({"simulate", "printed.json"});
  EXPECT_EQ(found, hash({"simulate", "variant.json", "--set", "/particle_spacing=0.1"}));
  EXPECT_NE(found, hash({"simulate", kScenes + "corner_drop.json", "--set", "/particle_spacing=0.1"}));
}

TEST_F(CommandLine, AReferenceForGammaIsForThatCommandAlone) {
  const std::string scene = kScenes + "corner_drop.json", set = "/boundary/gamma/method=monte_carlo";
  const std::vector<std::vector<std::string>> refused{
      {"simulate", scene, "--until", "0.01"},
      {"render", scene, "--out", "pictures"},
      {"view", scene},
      {"study", scene, "--vary", "/solver/max_iterations=1,2", "--until", "0.01", "--out", "study"}};
  for (std::vector<std::string> words : refused) {
    words.insert(words.end(), {"--set", set});
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 2) << words[0] << ": " << outcome.err;
    EXPECT_NE(outcome.err.find(scene + ":/boundary/gamma/method: expected a method that is quick enough"),
              std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("--set /boundary/gamma/method=auto"), std::string::npos) << "the remedy";
    EXPECT_TRUE(folderIsEmpty()) << words[0];
  }
  const Outcome varied = run({"study", scene, "--vary", "/boundary/gamma/method=auto,monte_carlo", "--until",
                              "0.01", "--out", "study"});
  EXPECT_EQ(varied.code, 2) << varied.err;
  EXPECT_TRUE(folderIsEmpty()) << "refused before the first run";

  EXPECT_EQ(run({"check", scene, "--set", set}).code, 0);
  std::ofstream(folder_ / "points.csv") << "x,y,z\n0.02,0.02,0.02\n";
  const Outcome gamma = run({"gamma", scene, "--set", set, "--set", "/boundary/gamma/samples=1000",
                             "--points", "points.csv", "--out", "gamma.csv"});
  EXPECT_EQ(gamma.code, 0) << gamma.err;
  // Nothing asks for gamma: the name stays valid.
  EXPECT_EQ(
      run({"simulate", scene, "--until", "0.01", "--quiet", "--set", set, "--set", "/boundary/handling=none"})
          .code,
      0);
}

// Points go in and come out as the scene has them, also where a float tells 3 cm apart.
TEST_F(CommandLine, GammaFarFromZeroIsThatAtZero) {
  const auto scene = [](const std::string& x) {
    return R"({ "format": 1, "particle_spacing": 0.05, "boundary": { "surfaces": [
        { "shape": "sphere", "fluid": "inside", "radius": 0.5, "center": [)" +
           x + "0.5, 0.5, 0.5] } ] } }";
  };
  std::ofstream(folder_ / "near.json") << scene("");
  std::ofstream(folder_ / "far.json") << scene("43125");
  std::ofstream(folder_ / "near.csv") << "x,y,z\n0.0625,0.5,0.5\n0.5078125,0.015625,0.5\n";
  std::ofstream(folder_ / "far.csv") << "x,y,z\n431250.0625,0.5,0.5\n431250.5078125,0.015625,0.5\n";
  for (const std::string name : {"near", "far"}) {
    const Outcome outcome = run({"gamma", name + ".json", "--points", name + ".csv", "--out",
                                 name + "_out.csv", "--set", "/boundary/gamma/method=directions"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  std::string expected = readAll(folder_ / "near_out.csv");
  for (const std::string x : {"0.0625,", "0.5078125,"})
    expected.replace(expected.find('\n' + x), x.size() + 1, "\n43125" + x);
  EXPECT_EQ(readAll(folder_ / "far_out.csv"), expected);
}

TEST_F(CommandLine, CheckListsTheFaultsOfAllFiles) {
  const Outcome outcome = run({"check", kBad + "broken_nan.json", kScenes + "dam_break.json", "missing.json",
                               kBad + "wrong_types.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, kScenes + "dam_break.json: ok (9216 particles at most)\n");
  EXPECT_NE(
      outcome.err.find("broken_nan.json:3:15: expected a value, found 'NaN'; JSON has finite numbers only\n"),
      std::string::npos);
  EXPECT_NE(outcome.err.find("missing.json: expected a scene file, found no such file\n"), std::string::npos);
  EXPECT_NE(outcome.err.find("wrong_types.json:/name: expected a text"), std::string::npos);
}

TEST_F(CommandLine, CheckPrintsASceneThatIsAScene) {
  const Outcome first =
      run({"check", "--print", kScenes + "dam_break.json", "--set", "/solver/tolerance=0.25"});
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("\"tolerance\": 0.25"), std::string::npos);
  std::ofstream(folder_ / "printed.json") << first.out;
  const Outcome second = run({"check", "--print", "printed.json"});
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(second.out, first.out);
}

TEST_F(CommandLine, ARefusedRunWritesNothingAndSaysAllOfIt) {
  const Outcome outcome = run({"simulate", kScenes + "dam_break.json", "--report", "report.json", "--set",
                               "/solver/tolerance=7", "--set", "/solver/tolerence=7", "--until", "-3"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(
      outcome.err,
      "--set /solver/tolerance: expected a number in [0, 1), found 7\n"
      "--set /solver/tolerence: expected a known key, found \"tolerence\"; did you mean \"tolerance\"?\n"
      "--until: expected a number in [0, 1e+06] (unit: s), found -3\n");
  EXPECT_TRUE(folderIsEmpty());
}

TEST_F(CommandLine, AReportThatCannotBeWrittenIsRefusedBeforeTheRun) {
  const Outcome outcome =
      run({"simulate", kScenes + "dam_break.json", "--until", "100000", "--report", "no/report.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err.find("--report: expected"), 0U) << outcome.err;
  EXPECT_TRUE(folderIsEmpty());
}

TEST_F(CommandLine, SimulateWritesAReportAndNothingElse) {
  const Outcome outcome = run({"simulate", kScenes + "corner_drop.json", "--until", "0.02", "--report",
                               "report.json", "--threads", "1"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "") << "no progress bar where there is no terminal";
  EXPECT_TRUE(fs::exists(folder_ / "report.json"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
  const std::string report = readAll(folder_ / "report.json");
  EXPECT_NE(report.find("\"steps\": 4,"), std::string::npos) << report;
  EXPECT_NE(report.find("\"threads\": 1,"), std::string::npos) << report;
}

TEST_F(CommandLine, SimulatePrintsASummaryWithoutAReport) {
  const Outcome outcome = run({"simulate", kScenes + "corner_drop.json", "--until", "0.01", "--quiet"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("particles"), std::string::npos) << outcome.out;
  EXPECT_TRUE(folderIsEmpty());
}

TEST_F(CommandLine, TheSameRunGivesTheSameHash) {
  std::vector<std::string> hashes;
  for (const char* threads : {"1", "1", "3"}) {
    const Outcome outcome = run({"simulate", kScenes + "corner_drop.json", "--until", "0.03", "--threads",
                                 threads, "--report", "report.json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string report = readAll(folder_ / "report.json");
    const std::size_t at = report.find("\"state_hash\": \"");
    ASSERT_NE(at, std::string::npos);
    hashes.push_back(report.substr(at, 32));
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST_F(CommandLine, WhatLeavesTheSceneIsCountedAndNoTrouble) {
  // So fast across an open floor that it has left the scene after a frame.
  std::ofstream(folder_ / "left.json") << R"({ "format": 1, "particle_spacing": 0.1,
    "fluid": [ { "shape": "box", "min": [0, 0, 0], "max": [0.2, 0.2, 0.2], "velocity": [5000, 0, 0] } ],
    "boundary": { "surfaces": [ { "shape": "plane", "point": [0, 0, 0], "normal": [0, 1, 0] } ] } })";
  const Outcome outcome = run({"simulate", "left.json", "--until", "1", "--report", "report.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string report = readAll(folder_ / "report.json");
  for (const char* part : {"\"particles\": 0,", "\"started\": 8", "\"lost_particles\": 0", "\"trouble\": []"})
    EXPECT_NE(report.find(part), std::string::npos) << part << " in " << report;
  const std::size_t left = report.find("\"left\":");
  ASSERT_NE(left, std::string::npos);
  EXPECT_LT(report.find("\"particles\": 8", left), report.find('}', left));
}

TEST_F(CommandLine, TroubleIsSaidOnceWhenItHappensAndNotInTheReportAlone) {
  // Fluid that begins in a wall is moved out of it at the start; the run goes on.
  std::ofstream(folder_ / "wall.json") << R"({ "format": 1, "particle_spacing": 0.1, "gravity": [0, 0, 0],
    "fluid": [ { "shape": "box", "min": [0, -0.1, 0], "max": [0.5, 0.4, 0.5], "trim": false } ],
    "boundary": { "surfaces": [ { "shape": "plane", "point": [0, 0, 0], "normal": [0, 1, 0] } ] } })";
  const Outcome outcome = run({"simulate", "wall.json", "--until", "0.02", "--report", "report.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::size_t said = outcome.err.find("wall.json: started_in_wall at step 0: ");
  EXPECT_NE(said, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("started_in_wall", said + 20), std::string::npos) << outcome.err;
  EXPECT_NE(readAll(folder_ / "report.json").find("started_in_wall"), std::string::npos);
}

TEST_F(CommandLine, SummaryComparesReports) {
  for (const char* handling : {"none", "gamma"}) {
    const Outcome outcome =
        run({"simulate", kScenes + "corner_drop.json", "--until", "0.01", "--set",
             std::string("/boundary/handling=") + handling, "--report", std::string(handling) + ".json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  const Outcome outcome = run({"summary", "none.json", "gamma.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find(" none  "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("edge crowding"), std::string::npos) << outcome.out;
  std::size_t width = outcome.out.find('\n');
  for (std::size_t at = 0; at < outcome.out.size(); at += width + 1)
    EXPECT_EQ(outcome.out.find('\n', at), at + width) << "aligned:\n" << outcome.out;
}

TEST_F(CommandLine, SummaryRefusesWhatIsNoReport) {
  const Outcome outcome = run({"summary", kScenes + "dam_break.json", "missing.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("dam_break.json:/: expected a report"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("missing.json: expected a report, found no such file"), std::string::npos)
      << outcome.err;
}

}  // namespace command_line_test
}  // namespace migiwa::testing
