// A folder for the files of this test program alone, so that ctest may run any two of them side by side.
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include <gtest/gtest.h>

namespace migiwa::testing {
namespace {

class OwnFolder : public ::testing::Environment {
 public:
  void SetUp() override {
    folder_ = (base_ / "migiwa_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(folder_.data()), nullptr) << folder_;
    setenv("TMPDIR", folder_.c_str(), 1);
    setenv("TEST_TMPDIR", (folder_ + "/").c_str(), 1);
  }
  void TearDown() override {
    std::error_code left;
    std::filesystem::remove_all(folder_, left);
  }

 private:
  const std::filesystem::path base_ = std::filesystem::temp_directory_path();
  std::string folder_;
};

[[maybe_unused]] const ::testing::Environment* const kOwnFolder =
    ::testing::AddGlobalTestEnvironment(new OwnFolder);

}  // namespace
}  // namespace migiwa::testing
