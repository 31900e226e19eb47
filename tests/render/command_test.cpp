// `migiwa render` as people call it.
#include "app/commands/command.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "app/platform/context.h"
#include "core/base/messages.h"
#include "tests/render/image_compare.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace command_test {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class RenderCommand : public ::testing::Test {
 protected:
  RenderCommand() {
    std::ofstream(scene_) << R"({
      "format": 1, "name": "Small", "duration": 0.1, "particle_spacing": 0.1,
      "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [0.5, 0.6, 0.5]}],
      "boundary": {"surfaces": [{"shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5]}]},
      "solver": {"max_iterations": 4}
    })";
  }
  ~RenderCommand() override { fs::remove_all(folder_); }

  int render(const fs::path& out, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"render",  scene_.string(), "--out",  out.string(),
                                       "--quiet", "--size",        "320x200"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const int code = runCommandLine(arguments);
    out_ = ::testing::internal::GetCapturedStdout();
    errors_ = ::testing::internal::GetCapturedStderr();
    return code;
  }

  fs::path folder_ = freshFolder("render_command");
  fs::path scene_ = folder_ / "small.json";
  std::string out_, errors_;
};

TEST_F(RenderCommand, WritesPicturesAndSidecarsAndNamesThem) {
  const fs::path out = folder_ / "new" / "pictures";
  ASSERT_EQ(render(out, {"--times", "0.05,0", "--set", "/view/color=speed"}), kDone) << errors_;
  EXPECT_EQ(out_, (out / "small_t0.000.png").string() + "\n" + (out / "small_t0.050.png").string() + "\n");
  const auto image = readPng(out / "small_t0.050.png");
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 320);
  EXPECT_EQ(image->height, 200);
  for (std::size_t i = 3; i < image->rgba.size(); i += 4) ASSERT_EQ(image->rgba[i], 255);

  const auto sidecar = nlohmann::json::parse(contents(out / "small_t0.050.json"));
  EXPECT_EQ(sidecar["scene"], scene_.string());
  EXPECT_EQ(sidecar["overrides"], nlohmann::json({"/view/color=speed"}));
  EXPECT_EQ(sidecar["time"], 0.05);
  EXPECT_EQ(sidecar["state_hash"].get<std::string>().size(), 16U);
  EXPECT_EQ(sidecar["color"]["field"], "speed");
  EXPECT_EQ(sidecar["color"]["unit"], "m/s");
  EXPECT_FALSE(sidecar["renderer"].get<std::string>().empty());
}

TEST_F(RenderCommand, TwoRunsWriteTheSameBytes) {
  for (const char* name : {"a", "b"})
    ASSERT_EQ(render(folder_ / name, {"--times", "0.1", "--ui"}), kDone) << errors_;
  for (const char* file : {"small_t0.100.png", "small_t0.100.json"}) {
    EXPECT_EQ(contents(folder_ / "a" / file), contents(folder_ / "b" / file)) << file;
    EXPECT_FALSE(contents(folder_ / "a" / file).empty());
  }
}

TEST_F(RenderCommand, TimesOnTheWayDoNotChangeTheState) {
  ASSERT_EQ(render(folder_ / "a", {"--times", "0.1"}), kDone);
  ASSERT_EQ(render(folder_ / "b", {"--times", "0,0.03,0.1"}), kDone);
  EXPECT_EQ(contents(folder_ / "a" / "small_t0.100.png"), contents(folder_ / "b" / "small_t0.100.png"));
}

TEST_F(RenderCommand, ComparisonIsOneSheetOfRowsAndColumns) {
  const fs::path out = folder_ / "sheet";
  ASSERT_EQ(render(out, {"--times", "0,0.05,0.1", "--compare", "/boundary/handling=none,gamma"}), kDone)
      << errors_;
  const auto sheet = readPng(out / "small_compare.png");
  ASSERT_TRUE(sheet);
  EXPECT_EQ(sheet->width, 3 * 320 + 2 * 6);
  EXPECT_EQ(sheet->height, 2 * 200 + 6);
  const auto sidecar = nlohmann::json::parse(contents(out / "small_compare.json"));
  ASSERT_EQ(sidecar["rows"].size(), 2U);
  ASSERT_EQ(sidecar["rows"][0].size(), 3U);
  EXPECT_EQ(sidecar["rows"][0][2]["overrides"], nlohmann::json({"/boundary/handling=none"}));
  EXPECT_EQ(sidecar["rows"][1][1]["time"], 0.05);
  EXPECT_NE(sidecar["rows"][0][2]["state_hash"], sidecar["rows"][1][2]["state_hash"]);
}

TEST_F(RenderCommand, ListsEveryFaultAndWritesNothing) {
  const fs::path out = folder_ / "nothing";
  EXPECT_EQ(render(out, {"--times", "0,x", "--set", "/particle_spacing=-1"}), kBadInput);
  EXPECT_NE(errors_.find("--times: expected"), std::string::npos) << errors_;
  EXPECT_NE(errors_.find("/particle_spacing: expected"), std::string::npos) << errors_;
  EXPECT_FALSE(fs::exists(out));
  EXPECT_EQ(render(out, {"--size", "10"}), kBadInput);
  EXPECT_EQ(render(out, {"--compare", "/boundary/handling=none,nonsense"}), kBadInput);
  EXPECT_EQ(render(scene_), kBadInput) << "the folder is a file";
  EXPECT_FALSE(fs::exists(out));
}

TEST(WindowTest, WithoutADisplaySaysWhatToInstall) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  try {
    const GlfwWindow window("none", 100, 100);
    FAIL() << "a window without a display";
  } catch (const MissingError& error) {
    EXPECT_NE(std::string(error.what()).find("apt-get install"), std::string::npos) << error.what();
  }
}

}  // namespace command_test
}  // namespace migiwa
