// The picture that `migiwa slim` draws beside its file.
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "app/command_line.h"
#include "app/commands/command.h"
#include "core/slim/file.h"
#include "tests/render/image_compare.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace slim_command_test {

namespace fs = std::filesystem;

class SlimCommand : public ::testing::Test {
 protected:
  SlimCommand() {
    std::ofstream(mesh_) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                            "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
  }
  ~SlimCommand() override { fs::remove_all(folder_); }

  fs::path folder_ = freshFolder("slim_command");
  fs::path mesh_ = folder_ / "cube.obj", out_ = folder_ / "cube.json", picture_ = folder_ / "cube.png";
};

TEST_F(SlimCommand, DrawsSurfaceAndNodesBesideTheFile) {
  ::testing::internal::CaptureStdout();
  const int code =
      runCommandLine({"slim", mesh_.string(), "--out", out_.string(), "--nodes", "300", "--quiet"});
  const std::string said = ::testing::internal::GetCapturedStdout();
  ASSERT_EQ(code, kDone);
  EXPECT_NE(said.find(picture_.string()), std::string::npos) << said;
  EXPECT_GT(readSlimFile(out_).nodes.size(), 50U);
  const auto picture = readPng(picture_);
  ASSERT_TRUE(picture);
  ASSERT_EQ(picture->width, 2 * 800 + 6);
  ASSERT_EQ(picture->height, 720);
  // In the middle of both halves, the cube: beige on the left, in the colours of the nodes on the right.
  const std::uint8_t *left = picture->pixel(400, 360), *right = picture->pixel(806 + 400, 360);
  EXPECT_GT(left[0], left[2]);
  EXPECT_LT(left[0] - left[2], 80);
  EXPECT_FALSE(std::equal(left, left + 3, right));
  // At a corner of both halves, the same backdrop.
  EXPECT_TRUE(std::equal(picture->pixel(790, 10), picture->pixel(790, 10) + 3, picture->pixel(1596, 10)));
}

TEST_F(SlimCommand, WithoutEglTheFileIsWrittenAllTheSame) {
  // The loader of EGL finds no driver.
  const std::string errors = (folder_ / "errors").string();
  const std::string command = "__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null '" MIGIWA_PROGRAM "' slim '" +
                              mesh_.string() + "' --out '" + out_.string() + "' --nodes 300 >/dev/null 2>'" +
                              errors + "'";
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kDone);
  EXPECT_TRUE(fs::exists(out_));
  EXPECT_FALSE(fs::exists(picture_));
  std::ostringstream said;
  said << std::ifstream(errors).rdbuf();
  EXPECT_NE(said.str().find("note: no picture " + picture_.string()), std::string::npos) << said.str();
}

TEST_F(SlimCommand, FileMustNotBeThePicture) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(runCommandLine({"slim", mesh_.string(), "--out", picture_.string()}), kBadInput);
  const std::string errors = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(errors.find("--out: expected a name that does not end in .png"), std::string::npos) << errors;
  EXPECT_FALSE(fs::exists(picture_));
}

}  // namespace slim_command_test
}  // namespace migiwa
