#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/base/files.h"
#include "core/base/messages.h"

namespace migiwa {
namespace output_file_test {

namespace fs = std::filesystem;

class OutputFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) /
        (std::string("migiwa_output_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::size_t filesInFolder() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static std::string read(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }

  fs::path folder_;
};

TEST_F(OutputFile, WritesAndReplaces) {
  const fs::path file = folder_ / "report.json";
  writeTextFile(file, "first, and longer");
  writeTextFile(file, "second");
  EXPECT_EQ(read(file), "second");
  EXPECT_EQ(filesInFolder(), 1U) << "nothing temporary is left";
}

TEST_F(OutputFile, LookingLeavesNothingBehind) {
  requireWritable(folder_ / "report.json", "--report");
  EXPECT_EQ(filesInFolder(), 0U);
  writeTextFile(folder_ / "report.json", "kept");
  requireWritable(folder_ / "report.json", "--report");
  EXPECT_EQ(read(folder_ / "report.json"), "kept");
}

TEST_F(OutputFile, ASymbolicLinkStays) {
  writeTextFile(folder_ / "real.json", "old");
  fs::create_symlink(folder_ / "real.json", folder_ / "link.json");
  writeTextFile(folder_ / "link.json", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.json"));
  EXPECT_EQ(read(folder_ / "real.json"), "new");
}

TEST_F(OutputFile, RefusesWhatCannotBeWrittenAndNamesTheOption) {
  const std::vector<fs::path> impossible{folder_, folder_ / "none" / "report.json", folder_ / "", fs::path()};
  for (const fs::path& file : impossible) {
    try {
      requireWritable(file, "--report");
      ADD_FAILURE() << file << " was accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.faults().at(0).place, "--report");
    }
  }
}

TEST_F(OutputFile, FailureIsAnErrorAndLeavesTheOldFile) {
  EXPECT_THROW(writeTextFile(folder_ / "none" / "report.json", "text"), std::runtime_error);
}

TEST_F(OutputFile, DevicesAreWrittenStraightAway) {
  requireWritable("/dev/null", "--report");
  writeTextFile("/dev/null", "text");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace output_file_test
}  // namespace migiwa
