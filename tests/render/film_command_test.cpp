// `migiwa render --film` as people call it, with encoders made up and real.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/raytrace/embree.h"
#include "tests/render/image_compare.h"
#include "tests/support/program.h"

namespace migiwa {
namespace film_command_test {

namespace fs = std::filesystem;

using testing::Outcome;
using testing::readAll;

class FilmCommand : public testing::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::create_directory(base_ / "bin");
    std::ofstream(folder_ / "small.json") << R"({
      "format": 1, "name": "Small", "duration": 0.1, "particle_spacing": 0.1,
      "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [0.5, 0.6, 0.5]}],
      "boundary": {"surfaces": [{"shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5]}]}
    })";
  }

  /// A program of this name and text is all that PATH has beside what a shell needs.
  void encoder(const std::string& name, const std::string& text) const {
    std::ofstream(base_ / "bin" / name) << "#!/bin/sh\n" << text << '\n';
    fs::permissions(base_ / "bin" / name, fs::perms::owner_all);
  }
  Outcome film(const std::string& file, std::vector<std::string> more = {},
               const std::string& before = "true") const {
    std::vector<std::string> words{"render", "small.json", "--film", file, "--size", "96x64"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words,
               "PATH=" + testing::shellQuoted((base_ / "bin").string()) + " && export PATH && " + before);
  }
  /// Copies the frames and its own words to a folder of the test, and makes a film of a word.
  void keepingEncoder(const std::string& name) const {
    const std::string kept = testing::shellQuoted((base_ / "kept").string());
    encoder(name, "export PATH=/usr/bin:/bin; mkdir -p " + kept + "; cp *.png " + kept + "; echo \"$@\" >" +
                      kept + "/words; for last; do :; done; echo film >\"$last\"");
  }
  std::string words() const { return readAll(base_ / "kept" / "words"); }
  /// But for the scene.
  bool nothingWritten() const {
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder_)) files += entry.path().extension() != ".json";
    return files == 0 && !fs::exists(folder_ / "a.webp.json");
  }
};

/// Frames are pressed less than pictures that stay.
void expectSamePicture(const fs::path& a, const fs::path& b) {
  const std::optional<Image> one = readPng(a), other = readPng(b);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->width, other->width);
  EXPECT_TRUE(one->rgba == other->rgba);
}

TEST_F(FilmCommand, AnEncoderGetsAFrameForEachTimeAndKeepsTime) {
  keepingEncoder("img2webp");
  const Outcome outcome = film("out/a.webp", {"--fps", "30"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "out/a.webp\n");
  EXPECT_EQ(readAll(folder_ / "out/a.webp"), "film\n");
  // 33.3 ms a frame in whole milliseconds: 33 + 34 + 33 + 33.
  EXPECT_NE(words().find("-d 33 000000.png -d 34 000001.png -d 33 000002.png 000003.png -o"),
            std::string::npos)
      << words();
  EXPECT_FALSE(fs::exists(base_ / "kept" / "000004.png"));
  ASSERT_EQ(run({"render", "small.json", "--out", "still", "--times", "0.1", "--size", "96x64"}).code, 0);
  expectSamePicture(base_ / "kept" / "000003.png", folder_ / "still/small_t0.100.png");
  const auto record = nlohmann::json::parse(readAll(folder_ / "out/a.webp.json"));
  EXPECT_EQ(record["film"]["frames"], 4);
  EXPECT_EQ(record["rows"][0]["time"], 0.1);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_ / "out")) ++files;
  EXPECT_EQ(files, 2U) << "the frames are gone";
}

TEST_F(FilmCommand, BeginsAndEndsWhereItIsTold) {
  keepingEncoder("ffmpeg");
  ASSERT_EQ(film("a.mp4", {"--fps", "100", "--from", "0.05", "--to", "0.07"}).code, 0);
  EXPECT_NE(words().find("-framerate 100 -i %06d.png"), std::string::npos) << words();
  EXPECT_TRUE(fs::exists(base_ / "kept" / "000002.png"));
  EXPECT_FALSE(fs::exists(base_ / "kept" / "000003.png"));
  ASSERT_EQ(run({"render", "small.json", "--out", "still", "--times", "0.05", "--size", "96x64"}).code, 0);
  expectSamePicture(base_ / "kept" / "000000.png", folder_ / "still/small_t0.050.png");
  ASSERT_EQ(film("a.webp", {"--to", "0"}).code, 0) << "ffmpeg makes WebP, too";
  EXPECT_NE(words().find("libwebp_anim"), std::string::npos) << words();
}

TEST_F(FilmCommand, ComparedRunsGoInStep) {
  keepingEncoder("img2webp");
  ASSERT_EQ(film("a.webp", {"--fps", "10", "--compare", "/boundary/handling=none,gamma"}).code, 0);
  const auto frame = readPng(base_ / "kept" / "000001.png");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->width, 96);
  EXPECT_EQ(frame->height, 2 * 64 + 6);
  const auto record = nlohmann::json::parse(readAll(folder_ / "a.webp.json"));
  EXPECT_EQ(record["rows"][0]["steps"], record["rows"][1]["steps"]);
  EXPECT_NE(record["rows"][0]["state_hash"], record["rows"][1]["state_hash"]);
}

TEST_F(FilmCommand, TracesRaysToo) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  keepingEncoder("img2webp");
  ASSERT_EQ(film("a.webp", {"--fps", "10", "--style", "raytraced", "--samples", "2"}).code, 0);
  EXPECT_TRUE(fs::exists(base_ / "kept" / "000001.png"));
}

/// Chunks of a RIFF file that have this name.
std::size_t chunks(const std::string& riff, const std::string& name) {
  std::size_t count = 0;
  for (std::size_t at = 12; at + 8 <= riff.size();) {
    count += riff.compare(at, 4, name) == 0;
    std::uint32_t size = 0;
    for (std::size_t k = 0; k < 4; ++k)
      size |= std::uint32_t{static_cast<std::uint8_t>(riff[at + 4 + k])} << (8 * k);
    at += 8 + size + (size & 1U);
  }
  return count;
}

TEST_F(FilmCommand, TheRealEncoderMakesAnAnimation) {
  if (std::system("command -v img2webp >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "img2webp is not installed here";
  const Outcome outcome = run({"render", "small.json", "--film", "with space.webp", "--size", "96x64"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string film = readAll(folder_ / "with space.webp");
  EXPECT_EQ(film.substr(8, 4), "WEBP");
  EXPECT_EQ(chunks(film, "ANMF"), 4U);
}

TEST_F(FilmCommand, WithoutAnEncoderTheFramesStay) {
  const Outcome outcome = film("out/a.webp", {"--fps", "20"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(
      outcome.err.find("out/a.webp was not made: a film of this kind needs img2webp or ffmpeg "
                       "(apt-get install webp or apt-get install ffmpeg); its 3 frames are in out/a_frames"),
      std::string::npos)
      << outcome.err;
  EXPECT_TRUE(readPng(folder_ / "out/a_frames/000002.png"));
  EXPECT_FALSE(fs::exists(folder_ / "out/a.webp"));
  const Outcome again = film("out/a.webp");
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.err.find("--film: expected no out/a_frames yet"), std::string::npos) << again.err;
}

TEST_F(FilmCommand, AnEncoderThatFailsLeavesNothing) {
  encoder("img2webp", "echo half >film.webp; echo 'no such codec' >&2; exit 3");
  std::ofstream(folder_ / "a.webp") << "older";
  Outcome outcome = film("a.webp");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("a.webp was not made: img2webp failed with exit code 3; it said: no such codec"),
            std::string::npos)
      << outcome.err;
  EXPECT_EQ(readAll(folder_ / "a.webp"), "older");
  fs::remove(folder_ / "a.webp");
  EXPECT_TRUE(nothingWritten());
  encoder("img2webp", "kill -9 $$");
  outcome = film("a.webp");
  EXPECT_NE(outcome.err.find("img2webp was killed by signal 9"), std::string::npos) << outcome.err;
  EXPECT_TRUE(nothingWritten());
}

TEST_F(FilmCommand, ADiskThatFillsLeavesNothing) {
  keepingEncoder("img2webp");
  // Files of at most a KiB stand for it.
  const Outcome outcome = film("a.webp", {}, "trap '' XFSZ; ulimit -f 1");
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  EXPECT_NE(outcome.err.find("a.webp"), std::string::npos) << outcome.err;
  EXPECT_TRUE(nothingWritten());
}

TEST_F(FilmCommand, NamesEveryFault) {
  keepingEncoder("img2webp");
  const auto refused = [&](const std::string& file, const std::vector<std::string>& more,
                           const std::vector<std::string>& texts) {
    const Outcome outcome = film(file, more);
    EXPECT_EQ(outcome.code, 2);
    for (const std::string& text : texts) EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
    EXPECT_TRUE(nothingWritten());
  };
  refused("a.gif", {"--fps", "0", "--out", "b"},
          {"--film: expected a file whose name ends in one of \".webp\", \".mp4\", found \"a.gif\"",
           "--fps: expected a number", "--out: expected it or --film, found both"});
  refused("a.webp", {"--from", "0.08", "--to", "0.05"},
          {"--from: expected a time at or before the end of the film, 0.05 s, found 0.08 s"});
  refused("a.webp", {"--from", "-1", "--fps", "-2"},
          {"--from: expected a number", "--fps: expected a number"});
  refused("a.webp", {"--to", "1e5", "--fps", "1000"}, {"--film: expected a film of at most 20000 frames"});
  refused("a.webp", {"--times", "0.1"}, {"--times: expected --from and --to beside --film"});
  refused("small.json/a.webp", {}, {"--film: expected"});
  const Outcome outcome = run({"render", "small.json", "--fps", "3"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("--out: expected a folder for the pictures, or --film"), std::string::npos);
  EXPECT_NE(outcome.err.find("--fps: expected --film beside it"), std::string::npos) << outcome.err;
}

}  // namespace film_command_test
}  // namespace migiwa
