// A study whose mesh is edited between its runs does not mix the two.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/study/study.h"
#include "tests/support/same_stamp.h"

namespace migiwa {
namespace edited_file_test {

namespace fs = std::filesystem;

std::string corner(const std::string& height) {
  return "v 0 0 0\nv 0.5 0 0\nv 0 0.5 0\nv 0 0 " + height + "\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

TEST(StudyOfAnEditedMesh, IsRefusedAtTheNextRepetition) {
  const fs::path folder = fs::path(::testing::TempDir()) / "migiwa_study_of_an_edited_mesh";
  fs::create_directories(folder);
  std::ofstream(folder / "corner.obj") << corner("0.50");
  std::ofstream(folder / "scene.json") << R"({ "format": 1, "particle_spacing": 0.1,
      "fluid": [ { "shape": "mesh", "file": "corner.obj" } ] })";
  const StudyPlan plan{folder / "scene.json", {}, {{"/solver/max_iterations", {"2"}}}, 0.02};
  const std::string before = runFingerprint(plan, 1);
  const auto ignore = [](const Simulation&) {};
  RunRecord record = firstRepetition(plan, 1, 1, [&](const Simulation&) {
    // While the run goes on.
    if (runFingerprint(plan, 1) == before) testing::rewriteUnseen(folder / "corner.obj", corner("0.55"));
  });
  EXPECT_EQ(record.fingerprint, before) << "that of what was simulated";
  EXPECT_NE(runFingerprint(plan, 1), before);
  try {
    repeatRun(plan, 1, 1, ignore, record);
    ADD_FAILURE() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("files of run 1 as they were"), std::string::npos)
        << error.what();
  }
  testing::rewriteUnseen(folder / "corner.obj", corner("0.50"));
  EXPECT_NO_THROW(repeatRun(plan, 1, 1, ignore, record));
  fs::remove_all(folder);
}

}  // namespace edited_file_test
}  // namespace migiwa
