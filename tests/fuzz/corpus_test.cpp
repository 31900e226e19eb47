// Every input of tests/fuzz/corpus, and pieces and single changed bytes of it, with the ordinary compiler:
// what fuzzing has once found stays mended, and where there is no libFuzzer there are still these. What is
// read is not looked at: this asks for no more than an end without a crash.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fuzz/fuzz_targets.h"

namespace migiwa::fuzz {
namespace corpus_test {

std::vector<std::filesystem::path> inputsOf(std::string_view target) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::string(MIGIWA_SOURCE_DIR "/tests/fuzz/corpus/") + std::string(target)))
    files.push_back(entry.path());
  return files;
}

class OnlyDoesNotCrash : public ::testing::TestWithParam<Target> {};

TEST_P(OnlyDoesNotCrash, OnTheCorpusItsPiecesAndChangedBytes) {
  const Target& target = GetParam();
  const auto files = inputsOf(target.name);
  ASSERT_FALSE(files.empty());
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename().string());
    std::ifstream in(file, std::ios::binary);
    std::ostringstream content;
    content << in.rdbuf();
    const std::string whole = content.str();
    EXPECT_NO_THROW(target.run(whole));
    constexpr std::size_t kPieces = 20;
    for (std::size_t k = 0; k < kPieces; ++k) {
      EXPECT_NO_THROW(target.run(whole.substr(0, k * whole.size() / kPieces))) << "cut short, " << k;
      std::string changed = whole;
      if (!changed.empty())
        changed[(2 * k + 1) * whole.size() / (2 * kPieces)] ^= static_cast<char>(1 + 37 * k);
      EXPECT_NO_THROW(target.run(changed)) << "with a byte changed, " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Corpus, OnlyDoesNotCrash, ::testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace corpus_test
}  // namespace migiwa::fuzz
