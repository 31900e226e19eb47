// Every shipped scene and ten hard cases after fifty frames: the state is that of tests/golden/hashes.json to
// the last bit, on every processor with AVX2 and with every instruction set of it that promises so. With
// --update the program writes the file anew instead: the physics was meant to change.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string_view>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "tests/support/instruction_sets.h"

namespace migiwa {
namespace golden_hashes_test {

namespace fs = std::filesystem;

constexpr int kFrames = 50;
const fs::path kRoot = MIGIWA_SOURCE_DIR;
const fs::path kGolden = kRoot / "tests" / "golden" / "hashes.json";

/// Of all kinds of walls, guards and steps.
constexpr std::string_view kHardCases[] = {
    "coincident", "gap_0.1",    "head_on",    "impact_edge_500", "lid_closed",
    "overlap_10", "plate_0.05", "slim_shell", "time_step_x100",  "wedge_to_nothing"};

/// Relative to the repository, with forward slashes.
std::vector<std::string> sceneFiles() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(kRoot / "scenes"))
    // The format's schema lies beside the scenes.
    if (entry.path().extension() == ".json" && entry.path().stem().extension() != ".schema")
      files.push_back("scenes/" + entry.path().filename().string());
  for (const std::string_view name : kHardCases)
    files.push_back("scenes/hard/" + std::string(name) + ".json");
  std::sort(files.begin(), files.end());
  return files;
}

std::string hashOf(const std::string& file) {
  Simulation simulation(readScene(kRoot / file));
  while (simulation.frame() < kFrames && !simulation.stopped()) simulation.advanceFrame();
  return hexDigits(simulation.stateHash());
}

nlohmann::json goldenHashes() {
  std::ifstream in(kGolden);
  return in ? nlohmann::json::parse(in) : nlohmann::json::object();
}

class GoldenHashes : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenHashes, AreThoseOfEveryMachine) {
  static const nlohmann::json golden = goldenHashes();
  ASSERT_TRUE(golden.contains(GetParam())) << "./run golden hashes adds it";
  const auto expected = golden[GetParam()].get<std::string>();
  int sets = 0;
  testing::onTargets(testing::promisesEqualState, [&] {
    EXPECT_EQ(hashOf(GetParam()), expected);
    ++sets;
  });
  if (sets == 0) GTEST_SKIP() << "this processor has no AVX2: its state is close, not equal";
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenHashes, ::testing::ValuesIn(sceneFiles()), [](const auto& file) {
  std::string name = file.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

TEST(GoldenHashFile, NamesNoSceneThatIsNotThere) {
  const std::vector<std::string> files = sceneFiles();
  const nlohmann::json golden = goldenHashes();
  for (const auto& [file, hash] : golden.items())
    EXPECT_TRUE(std::find(files.begin(), files.end(), file) != files.end()) << file;
}

void writeGoldenHashes() {
  nlohmann::json golden;
  for (const std::string& file : sceneFiles()) {
    golden[file] = hashOf(file);
    std::cout << file << ": " << golden[file].get<std::string>() << '\n';
  }
  writeTextFile(kGolden, golden.dump(2) + "\n");
}

}  // namespace golden_hashes_test
}  // namespace migiwa

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--update") {
    migiwa::golden_hashes_test::writeGoldenHashes();
    return 0;
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
