// The section in the window: what its panel's widgets do, that the picture shows the raster where it is, and
// that the command writes the same.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "app/command_line.h"
#include "app/commands/command.h"
#include "app/platform/context.h"
#include "app/session/section_session.h"
#include "app/viewer/viewer.h"
#include "core/base/files.h"
#include "core/scene/scene_file.h"
#include "core/simulation/simulation.h"
#include "tests/render/hands.h"
#include "tests/render/image_compare.h"
#include "tests/render/test_scene.h"

namespace migiwa {
namespace section_test {

constexpr int kWidth = 720, kHeight = 1000;

class SectionWindow : public ::testing::Test {
 protected:
  SectionWindow() {
    simulation_.watchPressure(true);
    for (int k = 0; k < 20; ++k) simulation_.advanceFrame();
    frame_.assign(simulation_.drawnView());
  }
  UiCommands frame(const InputState& input) {
    return viewer_.frame(frame_.view(), RunStatus{}, input, kWidth, kHeight);
  }
  SectionView& view() { return viewer_.view().section; }
  /// Until the section is that of now.
  void await() {
    for (int k = 0; k < 3; ++k) {
      sections_.poll(model_, view(), simulation_.scene(), viewer_.settings(), frame_.view());
      sections_.wait();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    sections_.poll(model_, view(), simulation_.scene(), viewer_.settings(), frame_.view());
    hands_.look();
  }
  Image picture() { return viewer_.picture(); }

  std::unique_ptr<GlContext> context_ = makeEglContext();
  Simulation simulation_{smallScene(), 1};
  FrameSnapshot frame_;
  SectionModel model_;
  SectionSession sections_{1};
  Viewer viewer_{simulation_.scene(), simulation_.walls(), {.scale = 1, .section = &model_}};
  testing::Hands hands_{[this](const InputState& input) { return frame(input); }};
};

TEST_F(SectionWindow, EveryWidgetOfItsPanelDoesWhatItSays) {
  hands_.look();
  if (!placeOfText("Show")) hands_.clickOn("Section");
  hands_.clickOn("Show", 100);
  ASSERT_TRUE(view().shown);
  const SectionView before = view();
  hands_.clickOn("Cut away");
  EXPECT_NE(view().cut, before.cut);
  hands_.clickOn("Lines");
  EXPECT_NE(view().lines, before.lines);
  hands_.clickOn("Fit");
  EXPECT_NE(view().fit, before.fit);
  hands_.choose("Field", "pressure");
  EXPECT_EQ(view().field, SectionField::pressure);
  hands_.choose("Divided", "by nothing");
  EXPECT_EQ(view().divisor, SectionDivisor::none);
  hands_.choose("Plane", "across x");
  EXPECT_EQ(view().axis, Axis::x);
  EXPECT_NEAR(view().at, 0.5, 1e-6) << "the middle";
  hands_.clickOn("At", 140);
  EXPECT_LT(view().at, 0.3);
  hands_.choose("Plane", "at an angle");
  EXPECT_TRUE(view().free);
  const Vec3d normal = view().normal;
  hands_.clickOn("Normal", 120);
  EXPECT_NE(view().normal, normal);
  await();
  ASSERT_TRUE(model_.raster);
  EXPECT_NEAR(std::abs(model_.raster->plane.normal().dot(view().direction())), 1, 1e-9);
  EXPECT_TRUE(hands_.clickOn("Save as CSV").saveSection);
}

TEST_F(SectionWindow, TheWheelWithControlMovesItAndNotTheCamera) {
  view().shown = true;
  view().axis = Axis::z, view().at = 0.25;
  const Camera camera = viewer_.view().camera;
  hands_.wheel(500, 500, 2, true);
  EXPECT_NEAR(view().at, 0.35, 1e-6) << "half a spacing a notch";
  EXPECT_EQ(viewer_.view().camera, camera);
  hands_.wheel(500, 500, 2, false);
  EXPECT_NE(viewer_.view().camera, camera);
}

/// The camera looks along z, the plane lies across it: pixels are places on it.
TEST_F(SectionWindow, ItsColoursAreThoseOfTheRasterWhereItIsAndSoIsWhatTheMouseReads) {
  view() = {.shown = true, .field = SectionField::pressure, .axis = Axis::z, .at = 0.2, .lines = false};
  await();
  ASSERT_TRUE(model_.raster);
  const Image shown = picture();
  const ColorMap colors = makeColorMap();
  const ColorFieldInfo info =
      sectionFieldInfo(SectionField::pressure, referenceSpeed(simulation_.scene()), 1000);
  const Rect area{321, 0, kWidth - 321, kHeight};
  const Projection projection = makeProjection(viewer_.view().camera, kWidth, kHeight, area);
  int seen = 0, read = 0;
  for (double x = 0.03; x < 1; x += 0.03) {
    for (double y = 0.03; y < 0.5; y += 0.03) {
      const Vec3d p(x, y, 0.2);
      const Eigen::Vector4f clip = projection.clip * projection.view *
                                   Eigen::Vector4f(static_cast<float>(x), static_cast<float>(y), 0.2F, 1);
      const float u = 321 + 0.5F * (1 + clip.x() / clip.w()) * static_cast<float>(area.width),
                  v = 0.5F * (1 - clip.y() / clip.w()) * static_cast<float>(area.height);
      const auto value = model_.raster->at(p);
      bool inside = value.has_value();
      for (const double dx : {-0.02, 0.02})
        for (const double dy : {-0.02, 0.02}) inside = inside && model_.raster->at(p + Vec3d(dx, dy, 0));
      if (!inside || (u < 560 && v < 180)) continue;  // the caption is there
      const double share =
          std::clamp((static_cast<double>(*value) - info.low) / (info.high - info.low), 0.0, 1.0);
      const Rgb8& wanted = colors[static_cast<std::size_t>(std::lround(share * (kColorMapSize - 1)))];
      const std::uint8_t* pixel = shown.pixel(static_cast<int>(u), static_cast<int>(v));
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], wanted[c], 14) << x << ' ' << y;
      ++seen;
      if (seen % 20 != 1) continue;
      InputState input;
      input.mouseInside = true;
      for (int k = 0; k < 2; ++k) {
        input.mouseX = u + static_cast<float>(k), input.mouseY = v;
        frame(input);
      }
      ASSERT_TRUE(model_.pointed) << x << ' ' << y;
      EXPECT_LT((*model_.pointed - p).norm(), 0.01);
      ++read;
    }
  }
  EXPECT_GT(seen, 40);
  EXPECT_GT(read, 2);
}

TEST_F(SectionWindow, ShowsOneMoreLegendAndIsGoneWhenItIsSwitchedOff) {
  viewer_.view().panels = false;  // they tell more than the picture
  hands_.look();
  const Image without = picture();
  view().shown = true;
  view().field = SectionField::gamma;
  await();
  EXPECT_GT(differentShare(without, picture()), 0.05);
  EXPECT_NE(shownText().find("section"), std::string::npos) << shownText();
  view().shown = false;
  await();
  EXPECT_EQ(model_.raster, nullptr);
  EXPECT_LT(differentShare(without, picture()), 0.002);
}

TEST_F(SectionWindow, SaysWhenThePlaneMissesTheScene) {
  view().shown = true;
  view().at = 100;
  await();
  EXPECT_EQ(model_.raster, nullptr);
  EXPECT_NE(model_.fault.find("misses"), std::string::npos) << model_.fault;
  view().at = 0.25;
  await();
  EXPECT_NE(model_.raster, nullptr);
}

TEST_F(SectionWindow, IsMadeAgainForWhatItsRasterDependsOnAlone) {
  view().shown = true, view().at = 0.25;
  await();
  const auto first = model_.raster;
  ASSERT_NE(first, nullptr);
  view().lines = !view().lines, view().fit = !view().fit, view().cut = !view().cut;
  view().normal = {1, 2, 3};  // it is across an axis
  await();
  EXPECT_EQ(model_.raster, first);
  view().divisor = SectionDivisor::none;
  await();
  EXPECT_NE(model_.raster, first);
}

/// A grid that no memory holds, asked for where one section is shown already.
TEST_F(SectionWindow, SettingsThatItCannotHaveAreTriedOnce) {
  view().shown = true, view().at = 0.25;
  await();
  ASSERT_NE(model_.raster, nullptr);
  Settings settings = viewer_.settings();
  const auto names = gammaMethodNames();
  settings.boundary.gammaMethod =
      static_cast<int>(std::find(names.begin(), names.end(), "baked") - names.begin());
  settings.solver.supportRatio = 1e-3;
  const auto poll = [&](const Settings& now) {
    const bool news = sections_.poll(model_, view(), simulation_.scene(), now, frame_.view());
    sections_.wait();
    return news;
  };
  poll(settings);
  EXPECT_TRUE(poll(settings));
  EXPECT_NE(model_.fault.find("grid"), std::string::npos) << model_.fault;
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(poll(settings)) << "asked again";
  poll(viewer_.settings());
  EXPECT_TRUE(poll(viewer_.settings()));
  EXPECT_EQ(model_.fault, "");
  EXPECT_NE(model_.raster, nullptr);
}

TEST_F(SectionWindow, OneAtAnAngleBeginsInTheMiddleOfAnotherView) {
  view().free = true, view().normal = {1, 1, 0};
  Scene scene = simulation_.scene();
  scene.view.clip = {.enabled = true, .axis = Axis::z, .at = 0.1};
  viewer_.replaceScene(scene, std::nullopt, 0);
  EXPECT_EQ(view().axis, Axis::z);
  EXPECT_NEAR(view().at, view().direction().dot(scene.bounds().center()), 1e-12);
}

/// What `migiwa section` writes of the same moment.
TEST_F(SectionWindow, ItsTableIsThatOfTheCommand) {
  const std::filesystem::path folder = freshFolder("section");
  writeTextFile(folder / "small.json", writeScene(smallScene()));
  for (const auto field : {SectionField::density, SectionField::pressure, SectionField::gamma}) {
    view() = {.shown = true, .field = field, .divisor = SectionDivisor::gamma, .axis = Axis::x, .at = 0.22};
    await();
    ASSERT_TRUE(model_.raster);
    const std::string name(kSectionFieldNames[static_cast<std::size_t>(field)]);
    ASSERT_EQ(runCommandLine({"section", (folder / "small.json").string(), "--time", "0.1", "--plane",
                              "x=0.22", "--field", name, "--divisor", "gamma", "--csv",
                              (folder / "s.csv").string(), "--quiet"}),
              kDone);
    std::ifstream in(folder / "s.csv");
    std::stringstream text;
    text << in.rdbuf();
    EXPECT_EQ(text.str(), sectionCsv(*model_.raster, Vec3d::Zero(), name));
    EXPECT_GT(text.str().size(), 100'000U);
  }
  std::filesystem::remove_all(folder);
}

TEST(SectionCommand, RefusesWhatItCannotDoAndSaysHow) {
  const std::filesystem::path folder = freshFolder("section_faults");
  writeTextFile(folder / "small.json", writeScene(smallScene()));
  const std::string scene = (folder / "small.json").string(), csv = (folder / "s.csv").string();
  const auto faultOf = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"section", scene});
    ::testing::internal::CaptureStderr();
    const int code = runCommandLine(words);
    EXPECT_EQ(code, kBadInput);
    return ::testing::internal::GetCapturedStderr();
  };
  EXPECT_NE(faultOf({}).find("--csv FILE or --png FILE"), std::string::npos);
  EXPECT_NE(faultOf({"--csv", csv, "--plane", "w=1"}).find("such as x=0.5"), std::string::npos);
  EXPECT_NE(faultOf({"--csv", csv, "--plane", "x=7"}).find("reaches from"), std::string::npos);
  EXPECT_NE(faultOf({"--csv", csv, "--normal", "0,0,0"}).find("--normal"), std::string::npos);
  EXPECT_NE(faultOf({"--csv", csv, "--field", "colour"}).find("\"gamma_error\""), std::string::npos);
  EXPECT_NE(faultOf({"--csv", csv, "--offset", "1"}).find("--normal beside it"), std::string::npos);
  EXPECT_NE(faultOf({"--csv", csv, "--png", (folder / "." / "s.csv").string()}).find("another file"),
            std::string::npos);
  EXPECT_NE(faultOf({"--csv", csv, "--field", "pressure"}).find("a step or more (0.005 s)"),
            std::string::npos);
  EXPECT_NE(faultOf({"--csv", csv, "--time", "-1"}).find("--time: expected a number in [0, 1e+06]"),
            std::string::npos);
  EXPECT_NE(faultOf({"--csv", csv, "--time", "1e6", "--set", "/solver/time_step=1e-9"})
                .find("--time: expected at most"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(csv));
  std::filesystem::remove_all(folder);
}

}  // namespace section_test
}  // namespace migiwa
