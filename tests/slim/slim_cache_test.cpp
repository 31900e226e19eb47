// Fits kept on disk: found again when nothing has changed, made anew when anything has, and never trusted
// when they are not whole.
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/base/files.h"
#include "core/walls/slim_wall.h"

namespace migiwa {
namespace slim_cache_test {

namespace fs = std::filesystem;

/// A cube of 12 triangles.
constexpr const char* kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

/// A cache and a mesh of its own for every test.
class SlimCache : public ::testing::Test {
 protected:
  SlimCache() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / test->name();
    fs::create_directories(folder_);
    if (const char* value = std::getenv("MIGIWA_CACHE")) before_ = value;
    setenv("MIGIWA_CACHE", (folder_ / "cache").c_str(), 1);
    source_.file = folder_ / "cube.obj";
    write(source_.file, kCube);
    source_.degree = 1;
    source_.nodes = 100;
  }
  ~SlimCache() override {
    fs::remove_all(folder_);
    before_.empty() ? unsetenv("MIGIWA_CACHE") : setenv("MIGIWA_CACHE", before_.c_str(), 1);
  }

  static void write(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  static std::string textOf(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }
  static fs::path fileOf(const SlimSource& source) { return slimFitFile(cacheFolder(), slimFitKey(source)); }

  fs::path folder_, before_;
  SlimSource source_;
};

TEST_F(SlimCache, GivesBackWhatWasFitted) {
  const std::shared_ptr<const SlimWallData> made = prepareSlim(source_);
  const std::string key = slimFitKey(source_);
  const std::optional<SlimFit> kept = readSlimFit(fileOf(source_), key);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->data.degree, 1);
  EXPECT_TRUE(kept->data.closed);
  ThreadPool pool(1);
  const SlimModel model(kept->data.nodes, 1, true, pool);
  ASSERT_EQ(model.nodes().size(), made->model->nodes().size());
  for (std::size_t k = 0; k < model.nodes().size(); ++k) {
    EXPECT_EQ(model.nodes()[k].centre, made->model->nodes()[k].centre);
    EXPECT_EQ(model.nodes()[k].coefficients, made->model->nodes()[k].coefficients);
  }
}

TEST_F(SlimCache, IsReadAtTheNextStart) {
  // A fit that no mesh gives: what comes back was read.
  SlimFit planted;
  planted.data.degree = 1;
  planted.data.nodes.resize(1);
  planted.data.nodes[0].radius = 0.5F;
  planted.notes = {"a note", "another note"};
  ASSERT_TRUE(writeSlimFit(fileOf(source_), slimFitKey(source_), planted));
  const std::shared_ptr<const SlimWallData> read = prepareSlim(source_);
  EXPECT_EQ(read->model->nodes().size(), 1U);
  EXPECT_EQ(read->notes, planted.notes);
}

TEST_F(SlimCache, IsNotReadWhileAllIsMadeAnew) {
  SlimFit planted;
  planted.data.degree = 1;
  planted.data.nodes.resize(1);
  planted.data.nodes[0].radius = 0.5F;
  ASSERT_TRUE(writeSlimFit(fileOf(source_), slimFitKey(source_), planted));
  EXPECT_EQ(prepareSlim(source_)->model->nodes().size(), 1U);
  std::size_t fitted = 0;
  {
    const CacheBypass anew;
    fitted = prepareSlim(source_)->model->nodes().size();
    EXPECT_GT(fitted, 50U);
  }
  // And it is kept, on disk and in memory.
  EXPECT_EQ(readSlimFit(fileOf(source_), slimFitKey(source_))->data.nodes.size(), fitted);
  EXPECT_EQ(prepareSlim(source_)->model->nodes().size(), fitted);
}

TEST_F(SlimCache, TheErrorOfAFitIsTheDistanceToItsShape) {
  source_.nodes = 3000;
  const std::shared_ptr<const SlimWallData> cube = prepareSlim(source_);
  EXPECT_LT(*slimFitError(source_, *cube->model), 0.004);
  // Of the same cube 0.1 further along x: two of its faces are off by that, the other four only where they
  // stick out, by 0.05 at the mean over a tenth of each.
  source_.transform.translate.x() = 0.1;
  const double expected = (2 * 0.1 + 4 * 0.1 * 0.05) / 6;
  EXPECT_NEAR(*slimFitError(source_, *cube->model), expected, 0.004);
}

TEST_F(SlimCache, TheKeyTellsAllThatMatters) {
  const std::string key = slimFitKey(source_);
  EXPECT_EQ(slimFitKey(source_), key);
  std::vector<SlimSource> others(7, source_);
  others[0].degree = 2;
  others[1].nodes = 101;
  others[2].tolerance = 0.01;
  others[3].transform.translate.y() = 1e-9;
  others[4].transform.scale = 2;
  others[5].kind = others[6].kind = SlimSource::Kind::bowl;
  others[6].bowl.height = 1;
  EXPECT_NE(slimFitKey(others[5]), slimFitKey(others[6]));
  for (const SlimSource& other : others) EXPECT_NE(slimFitKey(other), key);
  write(source_.file, std::string(kCube) + "# one more line\n");
  EXPECT_NE(slimFitKey(source_), key);
  // The same mesh in another place is the same.
  SlimSource moved = source_;
  moved.file = folder_ / "elsewhere.obj";
  write(moved.file, kCube);
  EXPECT_EQ(slimFitKey(moved), key);
  moved.file = folder_ / "none.obj";
  EXPECT_EQ(slimFitKey(moved), "");
}

TEST_F(SlimCache, FilesThatAreNotWholeOrNotAskedForAreNoFiles) {
  prepareSlim(source_);
  const std::string key = slimFitKey(source_), whole = textOf(fileOf(source_));
  ASSERT_GT(whole.size(), 1000U);
  const fs::path file = folder_ / "damaged.fit";
  for (std::size_t size = 0; size < whole.size(); size += 1 + size / 8) {
    write(file, whole.substr(0, size));
    EXPECT_FALSE(readSlimFit(file, key)) << size;
  }
  for (std::size_t at = 0; at < whole.size(); at += 97) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    write(file, changed);
    EXPECT_FALSE(readSlimFit(file, key)) << at;
  }
  write(file, whole + " ");
  EXPECT_FALSE(readSlimFit(file, key));
  write(file, whole);
  EXPECT_FALSE(readSlimFit(file, key + " "));
  EXPECT_TRUE(readSlimFit(file, key));
}

TEST_F(SlimCache, DoesWithoutAFolderThatCannotBeWritten) {
  setenv("MIGIWA_CACHE", "/dev/null/none", 1);
  SlimSource source = source_;
  source.nodes = 120;
  EXPECT_GT(prepareSlim(source)->model->nodes().size(), 50U);
}

}  // namespace slim_cache_test
}  // namespace migiwa
