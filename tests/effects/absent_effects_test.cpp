// A scene without effects costs nothing for them: a program from which they are left out gives the same state
// from the same stages with the same memory.
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace absent_effects_test {

/// What a probe prints of a scene of the given effects after 0.2 s.
std::string probe(const char* program, const std::string& scene, const std::string& effects) {
  namespace fs = std::filesystem;
  const fs::path file = fs::path(::testing::TempDir()) / ("absent_effects_" + scene + ".json");
  {
    const std::string text = R"({"format": 1, "include": ")" MIGIWA_SOURCE_DIR "/scenes/" + scene +
                             R"(.json", "effects": )" + effects + "}";
    std::FILE* const out = std::fopen(file.c_str(), "w");
    if (out == nullptr) return "cannot write the scene";
    std::fputs(text.c_str(), out);
    std::fclose(out);
  }
  std::FILE* const pipe = popen((std::string(program) + " '" + file.string() + "' 0.2").c_str(), "r");
  std::string printed;
  std::array<char, 512> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) printed += line.data();
  EXPECT_EQ(pclose(pipe), 0) << printed;
  return printed;
}

TEST(AbsentEffects, AreAbsent) {
  for (const char* scene : {"dam_break", "corner_drop"}) {
    const std::string with = probe(MIGIWA_PROBE, scene, R"({"viscosity": null})");
    const std::string without = probe(MIGIWA_BARE_PROBE, scene, R"({"viscosity": null})");
    EXPECT_EQ(with, without) << scene;
    EXPECT_NE(with.find(": neighbours predict gamma pressure move lambda position projection gamma_refresh "
                        "velocity check"),
              std::string::npos)
        << with;
    EXPECT_NE(with, probe(MIGIWA_PROBE, scene, R"({"viscosity": {}})")) << "a probe that sees nothing";
  }
}

}  // namespace absent_effects_test
