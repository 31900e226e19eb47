// `migiwa render --ui --script`: events at widgets by their names do what they would do in the window, two
// runs give the same bytes, and what cannot be done is told with its line and what there is.
#include <algorithm>

#include <gtest/gtest.h>

#include "app/command_line.h"
#include "app/commands/command.h"
#include "app/session/time_line.h"
#include "core/base/files.h"
#include "core/base/messages.h"
#include "core/scene/scene_file.h"
#include "tests/render/image_compare.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace script_test {

class Script : public ::testing::Test {
 protected:
  Script() { writeTextFile(folder_ / "small.json", writeScene(smallScene())); }
  ~Script() override { std::filesystem::remove_all(folder_); }

  int run(const std::string& script, const std::string& out, std::vector<std::string> more = {}) {
    writeTextFile(folder_ / "script.json", script);
    std::vector<std::string> words{"render",
                                   (folder_ / "small.json").string(),
                                   "--ui",
                                   "--script",
                                   (folder_ / "script.json").string(),
                                   "--out",
                                   (folder_ / out).string(),
                                   "--threads",
                                   "1",
                                   "--quiet",
                                   "--size",
                                   "900x1300",
                                   "--scale",
                                   "1"};
    words.insert(words.end(), more.begin(), more.end());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const int code = runCommandLine(words);
    error_ = ::testing::internal::GetCapturedStderr();
    ::testing::internal::GetCapturedStdout();
    return code;
  }
  Image picture(const std::string& name) const {
    const std::optional<Image> read = readPng(folder_ / name);
    EXPECT_TRUE(read) << name;
    return read.value_or(Image(1, 1));
  }
  std::string faultOf(const std::string& script) {
    EXPECT_EQ(run(script, "faulty"), kBadInput) << error_;
    return error_;
  }

  std::filesystem::path folder_ = freshFolder("script");
  std::string error_;
};

TEST_F(Script, GivesThePictureThatTheSameOptionsGive) {
  ASSERT_EQ(run(R"([
    {"choose": "Colour", "entry": "speed"},
    {"press": "Cut", "at": 0},
    {"choose": "Walls", "entry": "none"},
    {"play_to": 0.06},
    {"key": "h"},
    {"picture": "a.png"}
  ])",
                "out"),
            kDone)
      << error_;
  ::testing::internal::CaptureStdout();
  ASSERT_EQ(runCommandLine({"render", (folder_ / "small.json").string(), "--out", (folder_ / "same").string(),
                            "--times", "0.06", "--size", "900x1300", "--scale", "1", "--quiet", "--set",
                            "/view/color=speed", "--set", "/boundary/handling=none", "--set",
                            R"(/view/clip={"axis":"z","at":0.25})"}),
            kDone);
  ::testing::internal::GetCapturedStdout();
  EXPECT_LT(differentShare(picture("out/a.png"), picture("same/small_t0.060.png")), 0.0005);
}

TEST_F(Script, TwoRunsGiveTheSameBytes) {
  const std::string script = R"([
    {"drag": "Tolerance", "from": 0.2, "to": 0.8},
    {"drag_view": [[0.5, 0.5], [0.6, 0.55]]},
    {"drag_view": [[0.5, 0.5], [0.52, 0.5]], "button": "right"},
    {"wheel": 2, "over": [0.5, 0.5]},
    {"play_to": 0.1},
    {"drag_view": [[0.3, 0.3], [0.6, 0.7]], "control": true},
    {"choose": "Spread of", "entry": "speed"},
    {"move": [0.1, 0.9]},
    {"key": "f1"},
    {"wait_for": "Keys and mouse", "within": 5},
    {"key": "f1"},
    {"wait_while": "Keys and mouse", "within": 5},
    {"key": "left"},
    {"key": "z", "control": true},
    {"picture": "b.png"},
    {"key": "p"},
    {"wait": 0.2}
  ])";
  ASSERT_EQ(run(script, "one"), kDone) << error_;
  ASSERT_EQ(run(script, "two"), kDone) << error_;
  EXPECT_EQ(picture("one/b.png").rgba, picture("two/b.png").rgba);
  EXPECT_EQ(picture("one/migiwa_0001.png").rgba, picture("one/b.png").rgba) << "the key keeps what is seen";
  ASSERT_EQ(run(R"([{"picture": "b.png"}])", "plain"), kDone) << error_;
  EXPECT_GT(differentShare(picture("one/b.png"), picture("plain/b.png")), 0.02);
}

TEST_F(Script, TypesIntoWhatWasPressed) {
  ASSERT_EQ(run(R"([
    {"press": "File"},
    {"key": "a", "control": true},
    {"type": ")" + (folder_ / "list.csv").string() +
                    R"("},
    {"press": "CSV of particles"},
    {"wait_for": "particles of 0.000 s in"}
  ])",
                "out"),
            kDone)
      << error_;
  const std::string table = readTextFile(folder_ / "list.csv", "a table");
  EXPECT_TRUE(table.starts_with("id,x (m)"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 5 * 6 * 5);
}

TEST_F(Script, RefusesWhatItCannotDoWithItsLineAndWhatThereIs) {
  const std::string unknown =
      faultOf("[\n  {\"key\": \"h\"}, {\"key\": \"h\"},\n  {\"press\": \"Max iteration\"}\n]");
  EXPECT_NE(unknown.find("script.json:3: event 3: expected something that is shown"), std::string::npos)
      << unknown;
  EXPECT_NE(unknown.find("\"Max iterations\""), std::string::npos) << unknown;
  EXPECT_NE(faultOf(R"([{"pres": "Play"}])").find("found \"pres\"; did you mean \"press\"?"),
            std::string::npos)
      << error_;
  EXPECT_NE(faultOf(R"([{"press": "Play", "key": "h"}])").find("found both \"press\" and \"key\""),
            std::string::npos);
  EXPECT_NE(faultOf(R"([{"press": "Play", "where": 1}])").find("found \"where\""), std::string::npos)
      << error_;
  EXPECT_NE(faultOf(R"([{"press": 7}])").find("a text in \"press\", found 7"), std::string::npos) << error_;
  EXPECT_NE(faultOf(R"([{"key": "q"}])").find("\"space\""), std::string::npos) << error_;
  EXPECT_NE(faultOf(R"([{"click": [0.5, 1.5]}])").find("a place [x, y] in \"click\""), std::string::npos)
      << error_;
  EXPECT_NE(faultOf(R"([{"drag": "Tolerance", "from": 0}])").find("in \"to\", found none"), std::string::npos)
      << error_;
  EXPECT_NE(faultOf(R"([{"picture": "a.jpg"}])").find("ends in .png"), std::string::npos) << error_;
  EXPECT_NE(faultOf(R"([{"wait_for": "Ply", "within": 0.1}])").find("\"Play\""), std::string::npos) << error_;
  EXPECT_NE(faultOf(R"([{"wait_while": "Play", "within": 0.1}])").find("found it still there"),
            std::string::npos)
      << error_;
  EXPECT_NE(faultOf(R"({"press": "Play"})").find("expected a list of events"), std::string::npos) << error_;
  EXPECT_NE(faultOf("[{\"press\": }]").find("script.json:1:"), std::string::npos) << error_;
  EXPECT_NE(faultOf(R"([{"press": ""}])").find("a text of at least one letter"), std::string::npos) << error_;
  EXPECT_NE(faultOf(R"([{"picture": "none/a.png"}])").find("a name without a folder"), std::string::npos)
      << error_;
  EXPECT_NE(
      faultOf(R"([{"play_to": 0.05}, {"play_to": 0.02}])").find("a time at or after that of now, 0.05 s"),
      std::string::npos)
      << error_;
  // All that can be told before is told before, and at once.
  const std::string two = faultOf("[{\"picture\": \"a.png\"},\n{\"key\": \"q\"},\n{\"wait\": -1}]");
  EXPECT_NE(two.find("script.json:2: event 2"), std::string::npos) << two;
  EXPECT_NE(two.find("script.json:3: event 3"), std::string::npos) << two;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "faulty" / "a.png"));
}

TEST_F(Script, TypesLettersOfAnyAlphabet) {
  const std::filesystem::path table = folder_ / "größe γ ∇.csv";
  ASSERT_EQ(run(R"([
    {"press": "File"},
    {"key": "a", "control": true},
    {"type": ")" + table.string() +
                    R"("},
    {"press": "CSV of particles"},
    {"wait_for": "particles of 0.000 s in"}
  ])",
                "out"),
            kDone)
      << error_;
  EXPECT_TRUE(std::filesystem::exists(table));
}

TEST_F(Script, TellsManyFaultsWithTheirLines) {
  constexpr int kEvents = 20000;
  std::string script = "[";
  for (int k = 0; k < kEvents; ++k) script += std::string(k == 0 ? "" : ",") + "\n{\"type\": \"],[{\\\"\"}";
  const std::string fault = faultOf(script + ",\n\n{\"key\": \"q\"}]");
  EXPECT_NE(fault.find("script.json:20003: event 20001"), std::string::npos) << fault;
}

TEST_F(Script, FindsAWidgetInItsPanel) {
  const auto tolerances = [&](const std::string& in) {
    EXPECT_EQ(run(R"([{"press": "Energy"}, {"press": "Changes"}, {"press": "View"}, {"press": "Performance"},
                      {"press": "Tolerance", "at": 0.9, "in": ")" +
                      in + R"("}, {"picture": "a.png"}])",
                  in),
              kDone)
        << error_;
    return picture(in + "/a.png");
  };
  EXPECT_GT(differentShare(tolerances("Solver"), tolerances("What if")), 0.0005);
  EXPECT_NE(faultOf(R"([{"press": "Tolerance", "in": "Boundary"}])").find("in the panel \"Boundary\""),
            std::string::npos)
      << error_;
  EXPECT_NE(faultOf(R"([{"press": "Tolerance", "in": "Slover"}])").find("\"Solver\""), std::string::npos)
      << error_;
}

TEST_F(Script, TellsWhatCouldNotBeKept) {
  std::filesystem::create_directories(folder_ / "full" / "migiwa_0001.png");
  EXPECT_NE(run(R"([{"key": "p"}])", "full"), kDone);
  EXPECT_NE(error_.find("migiwa_0001.png"), std::string::npos) << error_;
}

TEST_F(Script, RefusesTimesOutOfReachAndTellsRepeatedKeysByLine) {
  EXPECT_EQ(run(R"([{"play_to": 1e5}])", "far", {"--set", "/solver/time_step=1e-6"}), kBadInput);
  EXPECT_NE(error_.find("script.json:1: event 1: expected at most 1000 s"), std::string::npos) << error_;
  EXPECT_NE(faultOf("[{\"key\": \"h\"},\n{\"key\": \"h\",\n\"key\": \"p\"}]").find("script.json:2: /1/key"),
            std::string::npos)
      << error_;
}

constexpr int kPlayed = 24;  ///< frames, of 5 ms

/// What the legend has then of a branch that went on without correction from a frame on.
std::string legendOf(const std::string& branch, RunMeasure measure, int correctedFrames) {
  const Scene scene = smallScene();
  Simulation simulation(scene, 1);
  for (int k = 0; k < kPlayed; ++k) {
    if (k == correctedFrames) {
      Settings settings = simulation.settings();
      settings.boundary.handling = BoundaryHandling::none;
      simulation.apply(settings);
    }
    simulation.advanceFrame();
  }
  const double value = static_cast<double>(Meter(scene).read(simulation)[measure]);
  return branch + ' ' + formatNumber("%.4g", value);
}

TEST_F(Script, PlotsBranchesOverEachOther) {
  const auto shows = [](const std::string& text) { return R"({"wait_for": ")" + text + R"("}, )"; };
  const auto showsBoth = [&](RunMeasure measure) {
    return shows(legendOf("1 run", measure, kPlayed)) +
           shows(legendOf("2 /boundary/handling=none", measure, 4));
  };
  EXPECT_NE(legendOf("", RunMeasure::height, kPlayed), legendOf("", RunMeasure::height, 4));
  EXPECT_EQ(
      run(R"([{"press": "Energy"}, {"press": "Changes"}, {"press": "View"}, {"play_to": 0.14}, {"key": "home"},
    {"play_to": 0.02}, {"key": "c"}, {"play_to": 0.12}, {"press": "Plots"}, )" +
              shows("Front (m) over time") + showsBoth(RunMeasure::front) +
              R"({"choose": "Plot of", "entry": "height"}, {"wait_while": "Front (m) over time"}, )" +
              shows("Height (m) over time") + showsBoth(RunMeasure::height) +
              R"({"picture": "a.png"}, {"key": "z", "control": true}, {"wait_while": "Height (m) over time"}, )" +
              showsBoth(RunMeasure::front) + R"({"picture": "b.png"}])",
          "plots"),
      kDone)
      << error_;
  EXPECT_GT(differentShare(picture("plots/a.png"), picture("plots/b.png")), 0.0005) << "another measure";
}

TEST_F(Script, KnowsTwoThemes) {
  ASSERT_EQ(
      run(R"([{"picture": "a.png"}, {"choose": "Theme", "entry": "light"}, {"picture": "b.png"}])", "light"),
      kDone)
      << error_;
  const Image dark = picture("light/a.png"), light = picture("light/b.png");
  EXPECT_LT(dark.pixel(4, 4)[0], 60) << "beside the first heading";
  EXPECT_GT(light.pixel(4, 4)[0], 200);
}

TEST_F(Script, StandsBesideTheWindowAlone) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--set-at", "0.1:/solver/tolerance=0.1"},
        {"--hide-walls"},
        {"--plane", "x=0.5"}}) {
    EXPECT_EQ(run("[]", "x", words), kBadInput) << words.front();
    EXPECT_NE(error_.find("found " + words.front()), std::string::npos) << error_;
  }
  EXPECT_EQ(run("[]", "x", {"--times", "0"}), kBadInput);
  EXPECT_NE(error_.find("--script"), std::string::npos);
  EXPECT_EQ(run("[]", "x", {"--compare", "/solver/tolerance=0.1,0.2"}), kBadInput);
  EXPECT_EQ(runCommandLine({"render", (folder_ / "small.json").string(), "--script", "s.json", "--out", "x"}),
            kBadInput);
}

}  // namespace script_test
}  // namespace migiwa
