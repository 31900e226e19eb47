// `migiwa surface` as a user runs it.
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace migiwa::testing {
namespace surface_command_test {

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

/// Of a tap that opens after the first frames.
TEST_F(SurfaceCommand, FramesWithoutParticlesAreMeshesWithoutTriangles) {
  std::ofstream(folder_ / "tap.json") << R"({"format": 1, "duration": 0.3, "particle_spacing": 0.05,
      "emitters": [{"shape": "disc", "center": [0.3, 0.5, 0.3], "radius": 0.1, "direction": [0, -1, 0],
                    "speed": 1, "start": 0.15}],
      "boundary": {"surfaces": [{"shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [0.6, 0.6, 0.6]}]}})";
  ASSERT_EQ(run({"surface", "tap.json", "--every", "0.1", "--out", "mesh"}).code, 0);
  for (const std::string format : {"ply", "vtk"}) {
    ASSERT_EQ(
        run({"simulate", "tap.json", "--export", "particles", "--every", "0.1", "--format", format}).code, 0);
    std::vector<std::string> command{"surface", "tap.json", "--out", format, "--particles"};
    for (const char* frame : {"0", "1", "2", "3"})
      command.push_back("particles/tap_00000" + std::string(frame) + "." + format);
    const Outcome outcome = run(command);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const std::string frame : {"0", "1", "2", "3"})
      EXPECT_EQ(readAll(folder_ / format / ("tap_00000" + frame + "_surface.ply")),
                readAll(folder_ / "mesh" / ("tap_surface_00000" + frame + ".ply")))
          << format << ' ' << frame;
  }
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

TEST_F(SurfaceCommand, WritesAScriptWithWhichBlenderRendersTheSequence) {
  ASSERT_EQ(
      run({"surface", "drop.json", "--every", "0.1", "--out", "mesh", "--for-blender", "--resolution", "1"})
          .code,
      0);
  const fs::path script = folder_ / "mesh/drop_surface_blender.py";
  ASSERT_TRUE(fs::exists(script));
  EXPECT_EQ(readAll(script).find('@'), std::string::npos);
  EXPECT_EQ(
      run({"surface", "drop.json", "--every", "1", "--out", "obj", "--for-blender", "--format", "obj"}).code,
      2);
  if (std::system("blender --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "Blender is not installed here";
  const std::string log = shellQuoted((base_ / "blender").string());
  const std::string command =
      "blender -b -P " + shellQuoted(script.string()) + " -- --samples 1 --size 64x36 >" + log + " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << readAll(base_ / "blender");
  for (const char* name : {"drop_surface_000000.png", "drop_surface_000001.png"})
    EXPECT_GT(readAll(folder_ / "mesh" / name).size(), 200u) << readAll(base_ / "blender");
}

TEST_F(SurfaceCommand, AResolutionWithoutRoomIsNamed) {
  // Drops far from each other, each with hundreds of blocks of the grid: gigabytes, where there are two.
  std::ofstream file(folder_ / "drops.ply");
  file << "ply\nformat ascii 1.0\nelement vertex 2000\nproperty float x\nproperty float y\nproperty float "
          "z\nend_header\n";
  for (int k = 0; k < 2000; ++k) file << k % 50 << ' ' << k / 50 << " 0\n";
  file.close();
  const Outcome outcome = run(
      {"surface", "--particles", "drops.ply", "--spacing", "0.05", "--out", "mesh", "--resolution", "0.1"},
      "ulimit -v 2000000");
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("--resolution: "), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::is_empty(folder_ / "mesh"));
}

TEST_F(SurfaceCommand, ADiskThatFillsLeavesNothingHalfWritten) {
  // Files of at most 8 KiB stand for it.
  const Outcome outcome =
      run({"surface", "drop.json", "--every", "0.1", "--out", "mesh"}, "trap '' XFSZ; ulimit -f 8");
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_NE(outcome.err.find("drop_surface_000000.ply"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::is_empty(folder_ / "mesh"));
}

}  // namespace surface_command_test
}  // namespace migiwa::testing
