// "Copy as command": what is on the clipboard, run by the program's own parser, draws what the window shows.
#include "app/session/command_text.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "app/command_line.h"
#include "app/commands/command.h"
#include "app/platform/context.h"
#include "app/session/time_line.h"
#include "app/viewer/scene_window.h"
#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/scene/scene_file.h"
#include "tests/render/image_compare.h"
#include "tests/render/window_over_scene.h"

namespace migiwa {
namespace command_text_test {

/// Words as a POSIX shell parts them, where there is nothing but single quotes and backslashes.
std::vector<std::string> shellWords(const std::string& line) {
  std::vector<std::string> words(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '\'')
      quoted = !quoted;
    else if (line[k] == '\\' && !quoted)
      words.back() += line[++k];
    else if (line[k] == ' ' && !quoted)
      words.emplace_back();
    else
      words.back() += line[k];
  }
  return words;
}

TEST(ShellWord, IsWhatAShellReadsBack) {
  for (const std::string word :
       {"a", "", "it's", "/view/camera={\"eye\":[1,2,3]}", "a b\\c", "$HOME `x`", "'"})
    EXPECT_EQ(shellWords(shellWord(word)), std::vector{word});
  EXPECT_EQ(shellWord("/solver/tolerance=0.01"), "/solver/tolerance=0.01") << "no quotes without need";
}

class CopyAsCommand : public WindowOverScene {
 protected:
  CopyAsCommand() : WindowOverScene("command text") {}

  /// The window's view, without what lies over it.
  Image seen() {
    hands_.press(Key::escape);
    hands_.look();
    const Image all = window_->viewer().picture();
    const Rect& area = window_->viewer().area();
    Image part(area.width, area.height);
    for (int y = 0; y < area.height; ++y)
      std::copy_n(all.pixel(area.x, area.y + y), 4 * area.width, part.pixel(0, y));
    return part;
  }
  /// The words on the clipboard, after the button was pressed.
  std::vector<std::string> copied() {
    hands_.clickOn("Copy as command");
    hands_.look();
    EXPECT_EQ(clipboardText(), window_->command().text);
    EXPECT_NE(shownText().find("It is on the clipboard"), std::string::npos);
    std::vector<std::string> words = shellWords(clipboardText());
    EXPECT_EQ(words.front(), "migiwa");
    words.erase(words.begin());
    EXPECT_EQ(words.back(), "pictures");
    words.back() = (folder_ / "pictures").string();
    words.insert(words.end(), {"--threads", "1", "--quiet"});
    return words;
  }
  /// Runs it, and compares state and picture.
  void expectTheSame(const std::vector<std::string>& words) {
    const Image wanted = seen();
    ::testing::internal::CaptureStdout();
    const int code = runCommandLine(words);
    std::string name = ::testing::internal::GetCapturedStdout();
    ASSERT_EQ(code, kDone) << window_->command().text;
    ASSERT_TRUE(name.ends_with(".png\n")) << name;
    name.pop_back();
    const std::optional<Image> drawn = readPng(name);
    ASSERT_TRUE(drawn);
    ASSERT_EQ(drawn->width, wanted.width);
    ASSERT_EQ(drawn->height, wanted.height);
    EXPECT_LT(differentShare(wanted, *drawn), kAllowedShare) << window_->command().text;
    std::filesystem::path beside = name;
    beside.replace_extension(".json");
    const std::string record = readTextFile(beside, "a record");
    EXPECT_NE(record.find(hexDigits(window_->frame().info.stateHash)), std::string::npos)
        << record << window_->command().text;
  }
};

TEST_F(CopyAsCommand, DrawsTheViewAsItIsTurned) {
  open();
  step(6);
  hands_.drag(700, 500, 760, 540);
  hands_.wheel(700, 500, 2);
  hands_.choose("Colour", "speed");
  hands_.clickOn("Cut", 100);
  const std::vector<std::string> words = copied();
  EXPECT_TRUE(window_->command().lacks.empty());
  expectTheSame(words);
  EXPECT_EQ(std::count(words.begin(), words.end(), "--set-at"), 0);
}

TEST_F(CopyAsCommand, HasOptionsAndSettingsThatWereChangedAtTheStartAndOnTheWay) {
  options_.overrides = {{"/solver/max_iterations", "6"}};
  open();
  hands_.clickOn("Tolerance", 130);
  await([&] {
    return window_->run().line.history.back().settings.solver.tolerance ==
           window_->viewer().settings().solver.tolerance;
  });
  step(4);
  hands_.press(Key::c);
  await([&] { return window_->frame().info.handling == "no correction"; });
  step(3);
  hands_.clickOn("Time step", 110);
  await([&] { return window_->run().line.history.size() == 4; });
  step(3);
  const std::vector<std::string> words = copied();
  expectTheSame(words);
  EXPECT_EQ(std::count(words.begin(), words.end(), "--set-at"), 3);
  // Without the changes on the way it would be another state.
  std::vector<std::string> without = words;
  for (auto at = std::find(without.begin(), without.end(), "--set-at"); at != without.end();
       at = std::find(without.begin(), without.end(), "--set-at"))
    without.erase(at, at + 2);
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(runCommandLine(without), kDone);
  std::filesystem::path record = ::testing::internal::GetCapturedStdout();
  record.replace_extension(".json");
  EXPECT_EQ(readTextFile(record, "a record").find(hexDigits(window_->frame().info.stateHash)),
            std::string::npos);
  // The settings that it ends with are those of the window.
  std::vector<Override> overrides;
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    if (words[k] == "--set") overrides.push_back(Override::parse(words[k + 1]));
    if (words[k] == "--set-at")
      overrides.push_back(Override::parse(words[k + 1].substr(words[k + 1].find(':') + 1)));
  }
  const Scene end = readScene(file_, overrides);
  EXPECT_TRUE(changesBetween({end.solver, end.boundary, end.effects}, window_->viewer().settings()).empty());
}

TEST_F(CopyAsCommand, FollowsTheTimeLineIntoABranch) {
  open();
  step(8);
  hands_.press(Key::left);
  hands_.press(Key::left);
  await([&] { return window_->run().line.frame == 6 && !window_->run().line.underWay; });
  hands_.press(Key::c);
  await([&] { return window_->run().line.branches.size() == 2; });
  step(4);
  expectTheSame(copied());
}

TEST_F(CopyAsCommand, DrawsTheSectionAtAnAngleAndTheWater) {
  open();
  view().section = {.shown = true,
                    .field = SectionField::pressure,
                    .divisor = SectionDivisor::gamma,
                    .free = true,
                    .normal = {0.3, 0.1, 1},
                    .at = 0.24,
                    .lines = false,
                    .fit = true};
  hands_.look();
  step(10);
  hands_.clickOn("Water");
  const auto walls = placeOfText("Walls", true);  // the last of them, of the view
  ASSERT_TRUE(walls);
  hands_.click((*walls)[0], (*walls)[1]);
  await([&] {
    return window_->frame().water != nullptr && !window_->busy() && !window_->frame().pressure.empty();
  });
  const std::vector<std::string> words = copied();
  EXPECT_EQ(std::count(words.begin(), words.end(), "--normal"), 1);
  EXPECT_EQ(std::count(words.begin(), words.end(), "--hide-walls"), 1);
  expectTheSame(words);
}

TEST_F(CopyAsCommand, DrawsTheSectionAcrossAnAxisWithoutACut) {
  open();
  view().section = {.shown = true, .field = SectionField::speed, .axis = Axis::x, .at = 0.21, .cut = false};
  hands_.look();
  step(10);
  hands_.drag(700, 500, 800, 520);
  await([&] { return !window_->busy(); });
  const std::vector<std::string> words = copied();
  EXPECT_EQ(std::count(words.begin(), words.end(), "--plane"), 1);
  EXPECT_EQ(std::count(words.begin(), words.end(), "--no-cut"), 1);
  expectTheSame(words);
}

TEST_F(CopyAsCommand, SaysWhatItLacks) {
  open();
  SceneWindow& window = *window_;
  const Scene& scene = window.viewer().scene();
  const TimeLineView line = window.run().line;
  const auto lacks = [&](bool saved, bool whole, bool inspects) {
    TimeLineView known = line;
    known.historyIsWhole = whole;
    return commandFor({.scene = scene,
                       .file = file_,
                       .overrides = {},
                       .saved = saved,
                       .line = known,
                       .settings = window.viewer().settings(),
                       .view = view(),
                       .width = 10,
                       .height = 10,
                       .inspects = inspects})
        .lacks.size();
  };
  EXPECT_EQ(lacks(true, true, false), 0U);
  EXPECT_EQ(lacks(false, true, false), 1U);
  EXPECT_EQ(lacks(true, false, false), 1U);
  EXPECT_EQ(lacks(false, false, true), 3U);
}

TEST(RenderOptionsOfTheWindow, AreRefusedWithTheirPlace) {
  const std::filesystem::path folder = freshFolder("render_window_options");
  writeTextFile(folder / "small.json", writeScene(smallScene()));
  const auto faultOf = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"render", (folder / "small.json").string(), "--out",
                                 (folder / "out").string(), "--times", "0"});
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(runCommandLine(words), kBadInput);
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(faultOf({"--set-at", "/solver/tolerance=1"}).find("0.5:/solver/tolerance=0.01"),
            std::string::npos);
  EXPECT_NE(faultOf({"--set-at", "-1:/solver/tolerance=0.1"}).find("[0, 1e+06]"), std::string::npos);
  EXPECT_NE(faultOf({"--set-at", "0.1:/particle_spacing=0.2"}).find("found /particle_spacing"),
            std::string::npos);
  EXPECT_NE(faultOf({"--set-at", "0.1:/solver/toleranc=0.2"}).find("toleranc"), std::string::npos);
  EXPECT_NE(faultOf({"--fit"}).find("--fit: expected --plane or --normal beside it"), std::string::npos);
  EXPECT_NE(faultOf({"--plane", "x=70"}).find("meets the scene"), std::string::npos);
  EXPECT_NE(faultOf({"--plane", "x=0.2", "--field", "colour"}).find("\"gamma_error\""), std::string::npos);
  EXPECT_NE(faultOf({"--scale", "100"}).find("--scale"), std::string::npos);
  EXPECT_NE(faultOf({"--plane", "x=0.2", "--style", "raytraced"}).find("--plane: expected --style"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  std::filesystem::remove_all(folder);
}

}  // namespace command_text_test
}  // namespace migiwa
