// The rules, held against the repository itself.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/structure/source_rules.h"

namespace migiwa::structure {
namespace tree_test {

namespace fs = std::filesystem;

bool isText(const fs::path& path) {
  const std::string name = path.filename().string();
  for (const char* ending :
       {".h", ".inl", ".cpp", ".cmake", ".txt", ".glsl", ".vert", ".frag", ".py", ".pyi"})
    if (name.ends_with(ending)) return true;
  return false;
}

std::vector<SourceFile> readTree() {
  const fs::path root = MIGIWA_SOURCE_DIR;
  std::vector<fs::path> paths{root / "run", root / "CMakeLists.txt", root / "packages.txt"};
  for (const char* folder : {"core", "app", "include", "python", "examples", "tests", "cmake", "shaders"})
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file() && isText(entry.path())) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());

  std::vector<SourceFile> files;
  for (const fs::path& path : paths) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    files.push_back({path.lexically_relative(root).generic_string(), text.str()});
  }
  return files;
}

const std::vector<SourceFile>& tree() {
  static const std::vector<SourceFile> files = readTree();
  return files;
}

void expectNone(const Violations& violations) {
  for (const std::string& violation : violations) ADD_FAILURE() << violation;
}

TEST(Tree, IsAllThere) {
  EXPECT_GT(tree().size(), 50u);
}
TEST(Tree, KeepsItsLayers) {
  expectNone(checkLayers(tree()));
}
TEST(Tree, KeepsItsBorders) {
  expectNone(checkBorders(tree()));
}
TEST(Tree, NamesItsIncludesFromTheRoot) {
  expectNone(checkIncludeStyle(tree()));
}
TEST(Tree, ComputesTheSameOnEveryMachine) {
  expectNone(checkPortability(tree()));
}
TEST(Tree, IsWrittenInChapters) {
  expectNone(checkChapters(tree()));
}
TEST(Tree, KeepsItsHabits) {
  expectNone(checkHabits(tree()));
}

}  // namespace tree_test
}  // namespace migiwa::structure
