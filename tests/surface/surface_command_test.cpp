// `migiwa surface` as a user runs it.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace migiwa::testing {
namespace {

namespace fs = std::filesystem;

class SurfaceCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(folder_ / "drop.json") << R"({"format": 1, "duration": 0.1, "particle_spacing": 0.05,
      "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [0.3, 0.3, 0.3]}],
      "boundary": {"surfaces": [{"shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [0.6, 0.6, 0.3]}]}})";
  }
  nlohmann::json list(const std::string& file) const {
    return nlohmann::json::parse(readAll(folder_ / file));
  }
};

TEST_F(SurfaceCommand, WritesASequenceAndItsList) {
  const Outcome outcome = run({"surface", "drop.json", "--every", "0.05", "--out", "mesh"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json files = list("mesh/drop_surface.ply.json").at("files");
  ASSERT_EQ(files.size(), 3u);
  for (const auto& entry : files) {
    EXPECT_TRUE(fs::exists(folder_ / "mesh" / entry.at("file").get<std::string>()));
    EXPECT_NEAR(entry.at("volume").get<double>(), 0.027, 0.0015);
    EXPECT_EQ(entry.at("particles"), 216);
  }
}

TEST_F(SurfaceCommand, OfExportedParticlesIsThatOfTheRun) {
  ASSERT_EQ(run({"surface", "drop.json", "--every", "0.1", "--out", "mesh", "--threads", "1"}).code, 0);
  for (const std::string format : {"ply", "vtk"}) {
    ASSERT_EQ(
        run({"simulate", "drop.json", "--export", "particles", "--every", "0.1", "--format", format}).code,
        0);
    const std::string file = "particles/drop_000001." + format;
    const Outcome outcome =
        run({"surface", "drop.json", "--particles", file, "--out", format, "--threads", "2"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(readAll(folder_ / format / "drop_000001_surface.ply"),
              readAll(folder_ / "mesh/drop_surface_000001.ply"));
  }
  const Outcome free = run({"surface", "--particles", "particles/drop_000001.ply", "--spacing", "0.05",
                            "--out", "free", "--format", "obj"});
  ASSERT_EQ(free.code, 0) << free.err;
  EXPECT_EQ(list("free/drop_000001_surface.obj.json").at("files").at(0).at("wet_triangles"), 0);
}

TEST_F(SurfaceCommand, NamesAllThatIsWrongAndWritesNothing) {
  std::ofstream(folder_ / "empty.ply") << "ply\nformat ascii 1.0\nelement vertex 0\nproperty float "
                                          "x\nproperty float y\nproperty float z\nend_header\n";
  Outcome outcome = run({"surface", "drop.json", "--out", "mesh", "--resolution", "0.01", "--format", "stl"});
  EXPECT_EQ(outcome.code, 2);
  for (const char* option : {"--every: ", "--resolution: ", "--format: "})
    EXPECT_NE(outcome.err.find(option), std::string::npos) << outcome.err;
  outcome = run({"surface", "--particles", "empty.ply", "--spacing", "0.05", "--out", "mesh"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("empty.ply: expected particles, found none"), std::string::npos) << outcome.err;
  outcome = run({"surface", "--particles", "empty.ply", "--out", "mesh"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("--spacing: "), std::string::npos) << outcome.err;
  outcome = run({"surface", "--out", "mesh"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("--particles"), std::string::npos) << outcome.err;
  outcome = run({"surface", "drop.json", "--every", "0.1", "--out", "drop.json"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_TRUE(!fs::exists(folder_ / "mesh") || fs::is_empty(folder_ / "mesh"));
}

TEST_F(SurfaceCommand, ADiskThatFillsLeavesNothingHalfWritten) {
  // Files of at most 8 KiB stand for it.
  const Outcome outcome =
      run({"surface", "drop.json", "--every", "0.1", "--out", "mesh"}, "trap '' XFSZ; ulimit -f 8");
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_NE(outcome.err.find("drop_surface_000000.ply"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::is_empty(folder_ / "mesh"));
}

}  // namespace
}  // namespace migiwa::testing
