// `migiwa render --style raytraced` as people call it.
#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/raytrace/embree.h"
#include "tests/render/image_compare.h"
#include "tests/support/program.h"

namespace migiwa {
namespace still_command_test {

class StillCommand : public testing::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::ofstream(folder_ / "small.json") << R"({
      "format": 1, "name": "Small", "duration": 0.1, "particle_spacing": 0.1,
      "fluid": [{"shape": "box", "min": [0, 0, 0], "max": [0.5, 0.6, 0.5]}],
      "boundary": {"surfaces": [
        {"shape": "box", "fluid": "inside", "min": [0, 0, 0], "max": [1, 1, 0.5]},
        {"shape": "sphere", "fluid": "outside", "center": [0.8, 0.1, 0.25], "radius": 0.1}]},
      "view": {"look": {"walls": [{"material": "glass"}, {"material": "matt"}]}}
    })";
  }

  testing::Outcome still(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> words{"render",  "small.json", "--style", "raytraced", "--out",     out,
                                   "--times", "0.1",        "--size",  "96x64",     "--samples", "4"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
};

TEST_F(StillCommand, WritesThePictureAndWhatItIs) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  // Without a display and without EGL.
  const testing::Outcome outcome = still("a");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto image = readPng(folder_ / "a" / "small_t0.100.png");
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 96);
  EXPECT_EQ(image->height, 64);
  std::size_t bright = 0;
  for (std::size_t i = 0; i < image->rgba.size(); i += 4) bright += image->rgba[i] > 40 ? 1U : 0U;
  EXPECT_GT(bright, image->rgba.size() / 8) << "it is no night picture";
  const auto sidecar = nlohmann::json::parse(testing::readAll(folder_ / "a" / "small_t0.100.json"));
  EXPECT_EQ(sidecar["style"], "raytraced");
  EXPECT_EQ(sidecar["samples"], 4);
  EXPECT_EQ(sidecar["seed"], 0);
}

TEST_F(StillCommand, ThreadsChangeNothingAndTheSeedDoes) {
  if (!raysAvailable()) GTEST_SKIP() << raysMissingAdvice();
  const auto picture = [&](const std::string& name, const std::vector<std::string>& more) {
    EXPECT_EQ(still(name, more).code, 0);
    return testing::readAll(folder_ / name / "small_t0.100.png");
  };
  const std::string one = picture("one", {"--threads", "1"});
  EXPECT_EQ(one, picture("two", {"--threads", "2"}));
  EXPECT_NE(one, picture("other", {"--seed", "7"}));
}

TEST_F(StillCommand, WithoutEmbreeItSaysWhatToInstall) {
  if (raysAvailable()) GTEST_SKIP() << "this program has Embree";
  const testing::Outcome outcome = still("none");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("libembree-dev"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
}

TEST_F(StillCommand, NamesEveryFault) {
  const auto refused = [&](const std::vector<std::string>& more, const std::string& text) {
    std::vector<std::string> words{"render", "small.json", "--out", "none"};
    words.insert(words.end(), more.begin(), more.end());
    const testing::Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 2) << text;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
  };
  refused({"--style", "painted"},
          "--style: expected one of \"particles\", \"water\", \"raytraced\", found \"painted\"");
  refused({"--style", "raytraced", "--ui", "--timings"}, "--ui: expected --style particles");
  refused({"--style", "raytraced", "--ui", "--timings"}, "--timings: expected --style particles");
  refused({"--samples", "8"}, "--samples: expected --style raytraced");
  refused({"--style", "raytraced", "--samples", "1"}, "--samples");
  refused({"--style", "raytraced", "--set", "/view/look/water_color=[1,2,0]"},
          "/view/look/water_color: expected red, green and blue from 0.001 to 1");
  refused({"--style", "raytraced", "--set",
           R"(/view/look/walls=[{"material":"glass"},{"material":"matt"},{"material":"glass"}])"},
          "/view/look/walls: expected at most one entry for each of boundary/surfaces (2), found 3");
}

}  // namespace still_command_test
}  // namespace migiwa
