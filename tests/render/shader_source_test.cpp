#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "app/render/gl.h"
#include "core/base/messages.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace shader_source_test {

class ShaderSourceTest : public ::testing::Test {
 protected:
  ~ShaderSourceTest() override {
    unsetenv("MIGIWA_SHADERS");
    std::filesystem::remove_all(folder_);
  }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

  std::filesystem::path folder_ = freshFolder("shaders");
};

TEST_F(ShaderSourceTest, IncludesAreResolved) {
  const std::string text = shaderSource("sphere.frag");
  EXPECT_TRUE(text.starts_with("#version 450 core")) << "that of frame.glsl, which it includes first";
  EXPECT_EQ(text.find("#include"), std::string::npos);
}

TEST_F(ShaderSourceTest, AFolderTakesTheirPlace) {
  write("sphere.frag", "#include \"part.glsl\"\nsecond\n");
  write("part.glsl", "first\n");
  setenv("MIGIWA_SHADERS", folder_.c_str(), 1);
  EXPECT_EQ(shaderSource("sphere.frag"), "first\nsecond\n");
  EXPECT_THROW(shaderSource("line.frag"), InputError);
}

}  // namespace shader_source_test
}  // namespace migiwa
