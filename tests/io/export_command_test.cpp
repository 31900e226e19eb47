// Particle sequences through the program, also of a run in two parts.
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/io/drop_test.h"
#include "tests/io/particle_files.h"

namespace migiwa::testing {
namespace export_command_test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class ExportCommand : public DropTest {
 protected:
  Outcome simulate(std::vector<std::string> options, const std::string& before = "true") const {
    options.insert(options.begin(), {"simulate", "drop.json", "--report", "report.json"});
    return run(options, before);
  }
  std::map<std::string, std::string> contents(const std::string& folder) const {
    std::map<std::string, std::string> result;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / folder))
      result[entry.path().filename().string()] = readAll(entry.path());
    return result;
  }
};

TEST_F(ExportCommand, StartAndEndAreExportedToo) {
  const Outcome outcome = simulate({"--export", "out/a", "--every", "0.03", "--format", "vtk"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto files = contents("out/a");
  EXPECT_EQ(files.size(), 7U);
  const Json list = Json::parse(files.at("drop.vtk.json"));
  std::vector<double> times;
  for (const Json& entry : list["files"]) times.push_back(entry["time"]);
  EXPECT_EQ(times, (std::vector<double>{0, 0.03, 0.06, 0.09, 0.1}));
  EXPECT_EQ(list["scene"], "drop.json");
  EXPECT_EQ(list["fields"]["velocity"]["unit"], "m/s");
  for (const auto& [name, content] : files) {
    if (name.ends_with(".vtk")) {
      EXPECT_EQ(readVtk(content).count, 512U) << name;
    }
  }
  EXPECT_EQ(list["files"].back()["state_hash"], Json::parse(readAll(folder_ / "report.json"))["state_hash"]);
}

TEST_F(ExportCommand, ExportingChangesNothing) {
  ASSERT_EQ(simulate({}).code, 0);
  const Json plain = Json::parse(readAll(folder_ / "report.json"));
  ASSERT_EQ(simulate({"--export", "a", "--every", "0.001"}).code, 0);
  EXPECT_EQ(Json::parse(readAll(folder_ / "report.json"))["state_hash"], plain["state_hash"]);
  EXPECT_EQ(contents("a").size(), 22U) << "21 frames and their list";
}

TEST_F(ExportCommand, ARunInTwoPartsExportsTheSameFiles) {
  const std::vector<std::string> fields{"--every", "0.02", "--fields",
                                        "density,gamma,lambda,neighbours,velocity"};
  const auto with = [&](std::vector<std::string> options) {
    options.insert(options.end(), fields.begin(), fields.end());
    return simulate(options);
  };
  ASSERT_EQ(with({"--export", "whole"}).code, 0);
  ASSERT_EQ(with({"--export", "parts", "--until", "0.05", "--save", "a.save"}).code, 0);
  const Outcome second = with({"--export", "parts", "--resume", "a.save", "--threads", "3"});
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(contents("parts"), contents("whole"));
  // A save that falls on an exported frame: that frame comes from the file, to the last bit.
  ASSERT_EQ(simulate({"--until", "0.04", "--save", "b.save"}).code, 0);
  ASSERT_EQ(with({"--export", "late", "--resume", "b.save"}).code, 0);
  auto late = contents("late"), expected = contents("whole");
  EXPECT_EQ(late.size(), 5U) << "from the third on, and a list";
  EXPECT_EQ(late.at("drop_000002.ply"), expected.at("drop_000002.ply"));
  EXPECT_EQ(late.at("drop_000005.ply"), expected.at("drop_000005.ply"));
}

TEST_F(ExportCommand, FilesOfALongerExportAreMentioned) {
  ASSERT_EQ(simulate({"--export", "a", "--every", "0.02"}).code, 0);
  const Outcome shorter = simulate({"--export", "a", "--every", "0.05"});
  EXPECT_EQ(shorter.code, 0);
  EXPECT_EQ(shorter.err, "a: warning: files of an earlier, longer export follow those of this one (3)\n");
}

TEST_F(ExportCommand, AFileLimitStopsTheRunAndLeavesWholeFiles) {
  const Outcome outcome = simulate({"--export", "a", "--every", "0.01", "--until", "100"}, "ulimit -f 1");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_EQ(outcome.err, "a/drop_000000.ply: could not be written: File too large\n");
  EXPECT_EQ(contents("a").size(), 0U);
  EXPECT_FALSE(fs::exists(folder_ / "report.json"));
}

TEST_F(ExportCommand, WrongWishesAreRefusedAllAtOnce) {
  const auto refused = [&](const std::vector<std::string>& options, const std::string& message) {
    const Outcome outcome = simulate(options);
    EXPECT_EQ(outcome.code, 2) << message;
    EXPECT_EQ(outcome.err, message);
  };
  refused({"--export", "a"}, "--export: expected --every S with it, found none\n");
  refused({"--every", "1", "--format", "ply", "--fields", "id"},
          "--every: expected --export DIR with it, found none\n"
          "--format: expected --export DIR with it, found none\n"
          "--fields: expected --export DIR with it, found none\n");
  refused(
      {"--export", "a", "--every", "0", "--format", "abc", "--fields", "id,speed,id"},
      "--format: expected one of \"ply\", \"vtk\", \"obj\", found \"abc\"\n"
      "--fields: expected some of \"velocity\", \"density\", \"gamma\", \"lambda\", \"neighbours\", \"id\", "
      "found \"speed\"\n"
      "--fields: expected each field once, found \"id\" again\n"
      "--every: expected a number in (0, 1e+06] (unit: s), found 0\n");
  refused({"--export", "a", "--every", "1", "--format", "obj", "--fields", "velocity"},
          "--fields: expected none with --format obj, which holds positions only; ply and vtk hold fields\n");
  refused({"--export", "drop.json", "--every", "1"},
          "--export: expected a folder, found the file drop.json\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace export_command_test
}  // namespace migiwa::testing
