// The files that `./run schema` writes are those that the program would write now.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/scene/scene_file.h"

namespace migiwa {
namespace schema_test {

constexpr std::string_view kRemedy = "is not what the program says any more: run ./run schema";

std::string textOf(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(std::string(MIGIWA_SOURCE_DIR "/scenes/") + file).rdbuf();
  return text.str();
}

TEST(Schema, FileIsInStep) {
  EXPECT_TRUE(textOf("scene.schema.json") == sceneSchema()) << "scenes/scene.schema.json " << kRemedy;
}

TEST(Schema, ReferenceIsInStep) {
  const std::string text = textOf("README.md");
  const std::size_t mark = text.find("<!-- The rest is written by `./run schema`");
  ASSERT_NE(mark, std::string::npos);
  const std::size_t begin = text.find('\n', mark);
  EXPECT_TRUE(text.substr(begin + 2) == sceneReference()) << "scenes/README.md " << kRemedy;
}

TEST(Schema, ReferenceHasEveryKindOfPlace) {
  const std::string text = sceneReference();
  for (const char* row :
       {"| `particle_spacing` | number in [1e-07, 1000] | m | 0.05 |",
        "| `gravity` | 3 numbers | m/s^2 | [0, -9.81, 0] |", "### `/solver`",
        "| `camera/eye` | 3 numbers | m | required |", "`/fluid/N` with `\"shape\": \"box\"`",
        "| `viscosity/xsph` | number in [0, 1] | 1 | 0.05 |",
        "| `tolerance` | number in [0, 1) | 1 | 0.003 |"})
    EXPECT_NE(text.find(row), std::string::npos) << row << " is not in\n" << text;
}

TEST(Schema, EveryFigureOfThePaperHasItsScene) {
  const std::string text = textOf("README.md");
  for (const char* figure : {"Figure 3", "Figures 4 and 5", "Figures 6 and 7", "Figure 8"})
    EXPECT_NE(text.find(figure), std::string::npos) << figure;
  // What the table names is there.
  for (std::size_t at = text.find("scenes/"); at != std::string::npos; at = text.find("scenes/", at + 1)) {
    const std::size_t end = text.find(".json", at);
    if (end == std::string::npos || text.substr(at, end - at).find_first_of(" `") != std::string::npos)
      continue;
    EXPECT_TRUE(std::filesystem::exists(MIGIWA_SOURCE_DIR "/" + text.substr(at, end - at + 5)))
        << text.substr(at, end - at + 5);
  }
}

}  // namespace schema_test
}  // namespace migiwa
