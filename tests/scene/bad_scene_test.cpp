// Every kind of bad input. Each bad/NAME.json has a NAME.expected: the messages, one a line, all of them and
// in order, with [...] for any text.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/base/messages.h"
#include "core/scene/scene_file.h"

namespace migiwa {
namespace bad_scene_test {

namespace fs = std::filesystem;

const fs::path kBad = MIGIWA_SOURCE_DIR "/tests/scene/bad";

std::vector<std::string> linesOf(std::istream&& in) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> faultsOf(const fs::path& file) {
  try {
    readScene(file);
  } catch (const InputError& error) {
    return linesOf(std::istringstream(error.what()));
  }
  return {};
}

/// Whether `text` is `pattern` with something in place of each [...].
bool matches(std::string_view text, std::string_view pattern) {
  const std::size_t gap = pattern.find("[...]");
  if (gap == std::string_view::npos) return text == pattern;
  if (text.substr(0, gap) != pattern.substr(0, gap)) return false;
  for (std::size_t begin = gap; begin <= text.size(); ++begin)
    if (matches(text.substr(begin), pattern.substr(gap + 5))) return true;
  return false;
}

/// With the files' names relative to the corpus.
std::string withoutFolder(std::string text) {
  const std::string folder = kBad.string() + "/";
  for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
    text.erase(at, folder.size());
  return text;
}

class BadScene : public ::testing::TestWithParam<std::string> {};

TEST_P(BadScene, IsRefusedWithTheseMessages) {
  const fs::path file = kBad / (GetParam() + ".json");
  const auto expected = linesOf(std::ifstream(kBad / (GetParam() + ".expected")));
  ASSERT_FALSE(expected.empty()) << "bad/" << GetParam() << ".expected is missing or empty";
  // Twice: the same messages in the same order every time, but for what free memory they name.
  for (int reading = 0; reading < 2; ++reading) {
    const auto found = faultsOf(file);
    ASSERT_FALSE(found.empty()) << "was accepted";
    std::string all;
    for (const std::string& line : found) all += line + "\n";
    ASSERT_EQ(found.size(), expected.size()) << all;
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_TRUE(found[k].starts_with(kBad.string() + "/")) << found[k];
      const std::string shown = withoutFolder(found[k]);
      EXPECT_TRUE(matches(shown, expected[k])) << "found    " << shown << "\nexpected " << expected[k];
    }
  }
}

std::vector<std::string> badScenes() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kBad))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Corpus, BadScene, ::testing::ValuesIn(badScenes()),
                         [](const auto& instance) { return instance.param; });

TEST(BadSceneFile, TheCorpusIsLarge) {
  EXPECT_GE(badScenes().size(), 70U);
}

TEST(BadSceneFile, Missing) {
  EXPECT_EQ(faultsOf("no/such/scene.json"),
            std::vector<std::string>{"no/such/scene.json: expected a scene file, found no such file"});
}

TEST(BadSceneFile, Folder) {
  EXPECT_EQ(faultsOf(kBad),
            std::vector<std::string>{kBad.string() + ": expected a scene file, found a folder"});
}

TEST(BadSceneFile, Endless) {
  EXPECT_EQ(faultsOf("/dev/zero"),
            std::vector<std::string>{"/dev/zero: expected a scene file, found more than 64 MiB"});
}

TEST(BadSceneText, EveryPrefixOfASceneIsRefused) {
  std::ostringstream whole;
  whole << std::ifstream(MIGIWA_SOURCE_DIR "/scenes/still_tank.json").rdbuf();
  const std::string text = whole.str();
  const std::size_t end = text.find_last_of('}');
  ASSERT_NE(end, std::string::npos);
  for (std::size_t size = 0; size <= end; ++size)
    EXPECT_THROW(parseScene(text.substr(0, size), "part.json"), InputError) << size;
}

TEST(BadSceneText, AByteOrderMarkDoesNoHarm) {
  EXPECT_EQ(parseScene("\xEF\xBB\xBF{ \"format\": 1, \"duration\": 2 }", "marked.json").duration, 2);
}

TEST(BadSceneText, DeepNestingIsRefusedInStride) {
  EXPECT_THROW(parseScene(std::string(1000000, '['), "deep.json"), InputError);
}

}  // namespace bad_scene_test
}  // namespace migiwa
